/** The handles of the canvas for keys and screen readers: sliders that lie where the handles are drawn. */

import { type NudgeAct, type NudgeState, nudgeEnd, nudgeStep, STILL } from "../../tools/nudge";
import { effect, h } from "../../ui";
import type { EditorCanvas } from "./canvas";
import type { EditorController } from "./editor_controller";
import { keyRecord } from "./events";
import { clampedPosition, handlesOnCanvas, type PositionHandle, positionHandles } from "./handles";

const NAMES = ["travel", "actuation", "reset", "onset"] as const;
const SAID: Readonly<Record<PositionHandle["name"], string>> = {
  travel: "Travel",
  actuation: "Actuation point",
  reset: "Reset point",
  onset: "Onset of the vibration",
};

/** One slider for each handle that a model can have; hidden where it has none. */
export function positionSliders(editor: EditorController, canvas: EditorCanvas): HTMLElement[] {
  return NAMES.map((name) => slider(editor, canvas, name));
}

function slider(editor: EditorController, canvas: EditorCanvas, name: PositionHandle["name"]): HTMLElement {
  const position = () => positionHandles(editor.model(), editor.active()).find((one) => one.name === name);
  const element = h("div", {
    class: "edit-slider",
    role: "slider",
    tabindex: 0,
    "aria-label": SAID[name],
    "aria-orientation": "horizontal",
    "aria-valuemin": 0,
    "aria-valuemax": () => (name === "travel" ? 20 : editor.model().travel_mm),
    "aria-valuenow": () => position()?.at_mm ?? null,
    "aria-valuetext": () => `${(position()?.at_mm ?? 0).toFixed(3)} mm`,
    hidden: () => !position(),
  });
  effect(() => {
    const at = handlesOnCanvas(canvas.plot.view(), editor.model(), editor.curve()).find(
      (one) => one.name === name,
    );
    if (at) element.style.transform = `translate(${at.x_px - 9}px, ${at.y_px - 9}px)`;
  });
  listen(editor, element, name);
  return element;
}

function listen(editor: EditorController, element: HTMLElement, name: PositionHandle["name"]): void {
  let state: NudgeState = STILL;
  let from: PositionHandle | undefined;
  const act = (one: NudgeAct) => {
    if (one.kind === "begin") {
      from = positionHandles(editor.model(), editor.active()).find((position) => position.name === name);
      editor.mark(`move ${name}`);
    } else if (one.kind === "nudge" && from) {
      editor.drag(from.edit(clampedPosition(editor.settled.peek(), name, from.at_mm + one.by.dx_mm, 0.005)));
    } else if (one.kind === "commit") editor.release();
    else if (one.kind === "cancel") editor.cancel();
  };
  const take = (event: KeyboardEvent) => {
    const answer = nudgeStep(state, keyRecord(event), "x");
    state = answer.state;
    answer.acts.forEach(act);
    if (answer.acts.length) event.preventDefault();
  };
  element.addEventListener("keydown", take);
  element.addEventListener("keyup", take);
  element.addEventListener("blur", () => {
    const answer = nudgeEnd(state);
    state = answer.state;
    answer.acts.forEach(act);
  });
}
