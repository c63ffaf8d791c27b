/** The keys of the editor: on the canvas arrows nudge and step, elsewhere shortcuts, all in the list of keys. */

import { controlPoints_mm, STROKES } from "../../math";
import { curveAt, movePoints } from "../../model";
import { type NudgeAct, type NudgeState, nudgeEnd, nudgeStep, STILL } from "../../tools/nudge";
import type { KeyRecord } from "../../tools/records";
import { stepped } from "../../tools/selection";
import { addShortcuts, batch } from "../../ui";
import type { EditorCanvas } from "./canvas";
import type { EditorController } from "./editor_controller";
import { keyRecord } from "./events";
import { pointsToMove } from "./every_speed";
import { pin } from "./pins";
import { addAt, removeSelected } from "./point_edits";
import type { PointerController } from "./pointer_controller";

/** Let the canvas be worked by keys, and tell which there are. */
export function listenForKeys(
  editor: EditorController,
  canvas: EditorCanvas,
  pointer: PointerController,
): void {
  const { element } = canvas.plot;
  let nudging: NudgeState = STILL;
  const nudged = (answer: { readonly state: NudgeState; readonly acts: readonly NudgeAct[] }) => {
    nudging = answer.state;
    batch(() => answer.acts.forEach((act) => nudgeAct(editor, act)));
    return answer.acts.length > 0;
  };
  element.addEventListener("keydown", (event) => {
    const record = keyRecord(event);
    const selected = editor.selection.peek().length > 0;
    const done =
      (selected && nudged(nudgeStep(nudging, record, "y"))) || canvasKey(editor, canvas, pointer, record);
    if (done) event.preventDefault();
  });
  element.addEventListener("keyup", (event) => void nudged(nudgeStep(nudging, keyRecord(event), "y")));
  element.addEventListener("blur", () => void nudged(nudgeEnd(nudging)));
  tellShortcuts(editor, canvas);
}

function nudgeAct(editor: EditorController, act: NudgeAct): void {
  if (act.kind === "begin") editor.mark("nudge");
  else if (act.kind === "commit") editor.release();
  else if (act.kind === "cancel") editor.cancel();
  else {
    const dragged = { curve: editor.curve(), followers: editor.followers() };
    const points = pointsToMove(dragged, editor.selection.peek());
    editor.drag(movePoints(points, act.by.dforce_cN, editor.constraints.peek()));
  }
}

/** What a key does on the canvas; false where it does nothing. */
function canvasKey(
  editor: EditorController,
  canvas: EditorCanvas,
  pointer: PointerController,
  { kind, key, shift, ctrl, alt }: KeyRecord,
): boolean {
  if (kind === "up") return false;
  const count = editor.curve().control_points_cN.length;
  const select = (points: readonly number[]) => {
    editor.selection.set(points);
    return true;
  };
  if (key === "Escape") {
    if (pointer.busy) pointer.cancel();
    else batch(() => [editor.selection.set([]), editor.span.set(null)]);
    return true;
  }
  if (ctrl && key === "a") return select(Array.from({ length: count }, (_, i) => i));
  if (ctrl || alt) return false;
  if (key === "ArrowRight" || key === "ArrowLeft")
    return select(stepped(editor.selection.peek(), count, key === "ArrowRight" ? 1 : -1, shift));
  if (key === "Home" || key === "End") return select([key === "Home" ? 0 : count - 1]);
  if (key === "Delete" || key === "Backspace") removeSelected(editor);
  else if (key === "Insert" || key === "a") addAt(editor, positionToAdd(editor, canvas));
  else if (key === "PageUp" || key === "PageDown") nextCurve(editor, key === "PageDown" ? 1 : -1);
  else return false;
  return true;
}

/** Under the pointer, else behind the selected point, else in the middle. */
function positionToAdd(editor: EditorController, canvas: EditorCanvas): number {
  const hover = canvas.hover.peek();
  if (hover) return Number(hover.x.toFixed(2));
  const positions = controlPoints_mm(editor.curve());
  const at = Math.min(
    positions.length - 2,
    editor.selection.peek().at(-1) ?? Math.floor(positions.length / 2),
  );
  return Number((0.5 * (positions[at]! + positions[at + 1]!)).toFixed(4));
}

/** Go through the curves in reading order. */
function nextCurve(editor: EditorController, by: 1 | -1): void {
  const { curves } = editor.model.peek();
  const active = curveAt(editor.model.peek(), editor.active.peek());
  const at = active ? curves.indexOf(active) : -1;
  editor.activate(curves[(at + by + curves.length) % curves.length]!);
}

/** Go to the other stroke at this velocity, if it is there. */
function otherStroke(editor: EditorController): void {
  const { stroke, velocity_mm_s } = editor.active.peek();
  const to = { stroke: STROKES.find((one) => one !== stroke)!, velocity_mm_s };
  if (curveAt(editor.model.peek(), to)) editor.activate(to);
}

function tellShortcuts(editor: EditorController, canvas: EditorCanvas): void {
  addShortcuts(
    { keys: "Ctrl+Z", does: "Undo", act: () => editor.step(-1) },
    { keys: "Ctrl+Shift+Z", does: "Redo", act: () => editor.step(1) },
    { keys: "Ctrl+Y", does: "Redo", act: () => editor.step(1) },
    { keys: "↑ ↓", does: "On the canvas: move the selected points by 1 cN; Shift 10 cN, Alt 0.1 cN" },
    { keys: "← →", does: "On the canvas: select the next point; Shift adds it" },
    { keys: "← → on a handle", does: "Move it by 0.05 mm; Shift 0.5 mm, Alt 0.005 mm" },
    { keys: "PageUp PageDown", does: "On the canvas: the next curve" },
    { keys: "A, Insert", does: "On the canvas: add a point" },
    { keys: "Delete", does: "Remove the selected points" },
    { keys: "Escape", does: "Cancel a drag, then the selection" },
    { keys: "Ctrl+A", does: "On the canvas: select all points" },
    { keys: "+ −", does: "On the canvas: zoom" },
    { keys: "F", does: "Fit all in view", act: () => canvas.plot.fit() },
    { keys: "S", does: "Press or release at this speed", act: () => otherStroke(editor) },
    {
      keys: "E",
      does: "Drag the active curve only, or every speed of its stroke",
      act: () => editor.everySpeed.update((on) => !on),
    },
    { keys: "P", does: "Pin the current state as the reference", act: () => pin(editor) },
    { keys: "B", does: "Show or hide the reference", act: () => editor.showBefore.update((on) => !on) },
    { keys: "C", does: "Go to the canvas", act: () => canvas.plot.element.focus() },
  );
}
