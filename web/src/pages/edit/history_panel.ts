/** Every step that was done, to go back to, and pinned states to compare with. */

import { button, h, panel } from "../../ui";
import type { Desk } from "./desk";
import { filled } from "./rows";

/** The panels of the history. */
export function historyPanels(desk: Desk): HTMLElement[] {
  return [panel("Steps", steps(desk)), panel("Compare with", before(desk))];
}

function steps(desk: Desk): HTMLElement {
  const rows = () => {
    desk.turns();
    const { steps: all, done } = desk.store.history;
    const entry = (label: string, at: number) =>
      h(
        "li",
        {},
        h(
          "button",
          { type: "button", class: `edit-step${at > done ? " undone" : ""}`, "aria-current": at === done ? "step" : null, on: { click: () => desk.step(at - desk.store.history.done) } },
          label,
        ),
      );
    return [entry("opened", 0), ...all.map((step, i) => entry(step.label, i + 1))].reverse();
  };
  return filled(h("ol", { class: "edit-steps", reversed: true, "aria-label": "Steps, the newest first" }), rows);
}

function before(desk: Desk): HTMLElement {
  const choices = () => {
    desk.turns();
    const { store } = desk;
    const pick = (label: string, model: typeof store.model) =>
      button({ label, kind: "quiet", act: () => desk.before.set(model), pressed: () => desk.before() === model });
    const pins = store.pins.map((pin, index) =>
      h("div", { class: "row spread" }, pick(pin.label, pin.model), button({ label: `Forget ${pin.label}`, glyph: "×", kind: "quiet", act: () => unpin(desk, index) })),
    );
    return [pick("as it was opened", store.history.opening), ...pins];
  };
  return h("div", { class: "stack" }, choices, button({ label: "Pin the present state", act: () => pin(desk) }));
}

/** Keep the present state and compare with it. */
export function pin(desk: Desk): void {
  const { store } = desk;
  store.pin(`pin ${store.pins.length + 1}: ${store.history.undoLabel ?? "as opened"}`);
  desk.before.set(store.pins.at(-1)!.model);
}

function unpin(desk: Desk, index: number): void {
  const gone = desk.store.pins[index]?.model;
  desk.store.unpin(index);
  if (desk.before.peek() === gone) desk.before.set(desk.store.history.opening);
}
