/** What the chosen rig makes of the active curve, in words below the canvas. */

import { choice, effect, h } from "../../ui";
import type { EditorController } from "./editor_controller";
import type { RigView } from "./rigs";

/** The strip of the rig: which one, whether it follows, why not, what to expect. */
export function verdictStrip(editor: EditorController, rig: RigView): HTMLElement {
  return h("section", { class: "edit-verdict", "aria-label": "On the rig" }, chooser(rig), () =>
    words(editor, rig),
  );
}

function chooser(rig: RigView): HTMLElement {
  const position = h("span", {});
  effect(() => {
    const options = rig.rigs().map(({ rig_id, simulated }) => {
      const name = rig_id.slice(rig_id.indexOf(":") + 1);
      return [rig_id, simulated ? `${name}, simulated` : name] as const;
    });
    const known = rig.rigs().some(({ rig_id }) => rig_id === rig.rig_id.peek());
    if (rig.rigs().length && !known && rig.rig_id.peek()) rig.rig_id.set(rig.rigs()[0]!.rig_id);
    position.replaceChildren(
      choice({
        label: "Rig",
        options: [...options, ["", "none"]],
        value: () => rig.rig_id(),
        set: (id) => rig.rig_id.set(id),
      }),
    );
  });
  return position;
}

function words(editor: EditorController, rig: RigView): HTMLElement[] {
  if (!rig.rig_id()) return [h("span", { class: "muted" }, "Choose a rig to see what it can render.")];
  if (rig.wrong()) return [h("span", { class: "wrong" }, rig.wrong())];
  const made = rig.curves().find((curve) => curve.stroke === editor.active().stroke);
  if (!made)
    return [h("span", { class: "muted" }, rig.waiting() ? "Identifying the rig, a few seconds…" : "")];
  const kind = made.verdict === "can follow" ? "good" : made.verdict === "cannot" ? "bad" : "partly";
  const at = editor.active().velocity_mm_s === null ? ` at ${made.velocity_mm_s} mm/s` : "";
  return [
    h("strong", { class: `edit-follows ${kind}` }, `${made.verdict}${at}`),
    h("span", {}, `expected error ${made.expected_mean_cN.toFixed(1)} cN, computed`),
    ...made.reasons.map((reason) => h("span", { class: "edit-reason" }, reason)),
  ];
}
