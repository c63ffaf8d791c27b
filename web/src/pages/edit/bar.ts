/** The bar above the editor: which button, what is saved, back and forth, what to take away. */

import type { Plot } from "../../draw";
import { button, h, on, toggle, toolbar } from "../../ui";
import type { EditorController } from "./editor_controller";
import { exportMenu } from "./exports";
import { pin } from "./history_panel";
import { buttonMenu } from "./menu";
import { savedWord, savingStrip } from "./saving";

/** The bar. */
export function bar(editor: EditorController, plot: Plot, id: () => string): HTMLElement {
  return h(
    "div",
    { class: "edit-bar" },
    h("h1", {}, () => editor.settled().name),
    h("span", { class: "tag" }, () => kindOf(id())),
    () => (editor.settled().provenance.simulated ? h("span", { class: "tag simulated" }, "simulated") : null),
    savedWord(editor),
    savingStrip(editor),
    h("span", { class: "grow" }),
    toolbar(
      "Edit",
      stepButton(editor, "Undo", "↶", -1),
      stepButton(editor, "Redo", "↷", 1),
      toggle({
        label: "Before",
        value: () => editor.showBefore(),
        set: (on) => editor.showBefore.set(on),
        hint: "Show the reference (B)",
      }),
      button({
        label: "Pin",
        act: () => pin(editor),
        hint: "Use the current state as the reference (P)",
      }),
      button({ label: "Zoom in", glyph: "+", act: () => plot.zoomBy(0.8) }),
      button({ label: "Zoom out", glyph: "−", act: () => plot.zoomBy(1.25) }),
      button({ label: "Fit", act: () => plot.fit(), hint: "Fit all in view (F)" }),
      buttonMenu(editor, id),
      exportMenu(editor, plot),
    ),
  );
}

/** Undo or redo, named after the step that it takes back or repeats. */
function stepButton(editor: EditorController, name: "Undo" | "Redo", glyph: string, by: -1 | 1): HTMLElement {
  const { history } = editor.store;
  const label = on(editor.turns, () => {
    const step = by < 0 ? history.undoLabel : history.redoLabel;
    return step === null ? name : `${name}: ${step}`;
  });
  const disabled = on(editor.turns, () => !(by < 0 ? history.canUndo : history.canRedo));
  const attributes = { type: "button", class: "button glyph", "aria-label": label, title: label, disabled };
  return h("button", { ...attributes, on: { click: () => editor.step(by) } }, glyph);
}

/** Where a button comes from, in words. */
function kindOf(id: string): string {
  const kind = id.slice(0, id.indexOf(":"));
  return kind === "own" ? "own" : `${kind}; editing makes your own copy`;
}
