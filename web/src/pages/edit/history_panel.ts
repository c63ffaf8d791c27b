/** Every step that was done, to go back to, and pinned states to compare with. */

import { button, h, panel } from "../../ui";
import type { EditorController } from "./editor_controller";
import { filled } from "./rows";

/** The panels of the history. */
export function historyPanels(editor: EditorController): HTMLElement[] {
  return [panel("Steps", steps(editor)), panel("Compare with", before(editor))];
}

function steps(editor: EditorController): HTMLElement {
  const rows = () => {
    editor.turns();
    const { steps: all, done } = editor.store.history;
    const entry = (label: string, at: number) =>
      h(
        "li",
        {},
        h(
          "button",
          {
            type: "button",
            class: `edit-step${at > done ? " undone" : ""}`,
            "aria-current": at === done ? "step" : null,
            on: { click: () => editor.step(at - editor.store.history.done) },
          },
          label,
        ),
      );
    return [entry("opened", 0), ...all.map((step, i) => entry(step.label, i + 1))].reverse();
  };
  return filled(
    h("ol", { class: "edit-steps", reversed: true, "aria-label": "Steps, the newest first" }),
    rows,
  );
}

function before(editor: EditorController): HTMLElement {
  const choices = () => {
    editor.turns();
    const { store } = editor;
    const pick = (label: string, model: typeof store.model) =>
      button({
        label,
        kind: "quiet",
        act: () => editor.before.set(model),
        pressed: () => editor.before() === model,
      });
    const pins = store.pins.map((pin, index) =>
      h(
        "div",
        { class: "row spread" },
        pick(pin.label, pin.model),
        button({ label: `Forget ${pin.label}`, glyph: "×", kind: "quiet", act: () => unpin(editor, index) }),
      ),
    );
    return [pick("as opened", store.history.opening), ...pins];
  };
  return h(
    "div",
    { class: "stack" },
    choices,
    button({ label: "Pin the current state", act: () => pin(editor) }),
  );
}

/** Keep the present state and compare with it. */
export function pin(editor: EditorController): void {
  const { store } = editor;
  store.pin(`pin ${store.pins.length + 1}: ${store.history.undoLabel ?? "as opened"}`);
  editor.before.set(store.pins.at(-1)!.model);
}

function unpin(editor: EditorController, index: number): void {
  const gone = editor.store.pins[index]?.model;
  editor.store.unpin(index);
  if (editor.before.peek() === gone) editor.before.set(editor.store.history.opening);
}
