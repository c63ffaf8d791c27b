/** The keys of the editor: on the canvas arrows nudge and step, elsewhere shortcuts, all told by the list of keys. */

import { controlPoints_mm, STROKES } from "../../math";
import { curveAt, movePoints } from "../../model";
import { nudgeEnd, type NudgeAct, type NudgeState, nudgeStep, STILL } from "../../tools/nudge";
import type { KeyRecord } from "../../tools/records";
import { stepped } from "../../tools/selection";
import { addShortcuts, batch } from "../../ui";
import type { EditorCanvas } from "./canvas";
import { type Desk, refOf } from "./desk";
import { keyRecord } from "./events";
import type { Hand } from "./hand";
import { pin } from "./history_panel";
import { addAt, removeSelected } from "./point_edits";

/** Let the canvas be worked by keys, and tell which there are. */
export function listenForKeys(desk: Desk, canvas: EditorCanvas, hand: Hand): void {
  const { element } = canvas.plot;
  let nudging: NudgeState = STILL;
  const nudged = (told: { readonly state: NudgeState; readonly acts: readonly NudgeAct[] }) => {
    nudging = told.state;
    batch(() => told.acts.forEach((act) => nudgeAct(desk, act)));
    return told.acts.length > 0;
  };
  element.addEventListener("keydown", (event) => {
    const record = keyRecord(event);
    const selected = desk.selection.peek().length > 0;
    const done = (selected && nudged(nudgeStep(nudging, record, "y"))) || canvasKey(desk, canvas, hand, record);
    if (done) event.preventDefault();
  });
  element.addEventListener("keyup", (event) => void nudged(nudgeStep(nudging, keyRecord(event), "y")));
  element.addEventListener("blur", () => void nudged(nudgeEnd(nudging)));
  tellShortcuts(desk, canvas);
}

function nudgeAct(desk: Desk, act: NudgeAct): void {
  if (act.kind === "begin") desk.mark("nudge");
  else if (act.kind === "commit") desk.release();
  else if (act.kind === "cancel") desk.cancel();
  else {
    const points = [{ ...refOf(desk.curve()), indices: desk.selection.peek() }];
    desk.drag(movePoints(points, act.by.dforce_cN, desk.constraints.peek()));
  }
}

/** What a key does on the canvas; false where it does nothing. */
function canvasKey(desk: Desk, canvas: EditorCanvas, hand: Hand, { kind, key, shift, ctrl, alt }: KeyRecord): boolean {
  if (kind === "up") return false;
  const count = desk.curve().control_points_cN.length;
  const select = (points: readonly number[]) => {
    desk.selection.set(points);
    return true;
  };
  if (key === "Escape") {
    if (hand.busy) hand.cancel();
    else batch(() => [desk.selection.set([]), desk.span.set(null)]);
    return true;
  }
  if (ctrl && key === "a") return select(Array.from({ length: count }, (_, i) => i));
  if (ctrl || alt) return false;
  if (key === "ArrowRight" || key === "ArrowLeft") return select(stepped(desk.selection.peek(), count, key === "ArrowRight" ? 1 : -1, shift));
  if (key === "Home" || key === "End") return select([key === "Home" ? 0 : count - 1]);
  if (key === "Delete" || key === "Backspace") removeSelected(desk);
  else if (key === "Insert" || key === "a") addAt(desk, placeToAdd(desk, canvas));
  else if (key === "PageUp" || key === "PageDown") nextCurve(desk, key === "PageDown" ? 1 : -1);
  else return false;
  return true;
}

/** Under the pointer, else behind the selected point, else in the middle. */
function placeToAdd(desk: Desk, canvas: EditorCanvas): number {
  const hover = canvas.hover.peek();
  if (hover) return Number(hover.x.toFixed(2));
  const places = controlPoints_mm(desk.curve());
  const at = Math.min(places.length - 2, desk.selection.peek().at(-1) ?? Math.floor(places.length / 2));
  return Number((0.5 * (places[at]! + places[at + 1]!)).toFixed(4));
}

/** Go through the curves in reading order. */
export function nextCurve(desk: Desk, by: 1 | -1): void {
  const { curves } = desk.model.peek();
  const at = curves.findIndex((c) => c === curveAt(desk.model.peek(), desk.active.peek()));
  desk.activate(curves[(at + by + curves.length) % curves.length]!);
}

/** Go to the other stroke at this velocity, if it is there. */
function otherStroke(desk: Desk): void {
  const { stroke, velocity_mm_s } = desk.active.peek();
  const to = { stroke: STROKES.find((one) => one !== stroke)!, velocity_mm_s };
  if (curveAt(desk.model.peek(), to)) desk.activate(to);
}

function tellShortcuts(desk: Desk, canvas: EditorCanvas): void {
  addShortcuts(
    { keys: "Ctrl+Z", does: "Undo", act: () => desk.step(-1) },
    { keys: "Ctrl+Shift+Z", does: "Redo", act: () => desk.step(1) },
    { keys: "Ctrl+Y", does: "Redo", act: () => desk.step(1) },
    { keys: "↑ ↓", does: "On the canvas: move the selected points by 1 cN; Shift 10 cN, Alt 0.1 cN" },
    { keys: "← →", does: "On the canvas: the next point; with Shift as well" },
    { keys: "← → on a handle", does: "Move it by 0.05 mm; Shift 0.5 mm, Alt 0.005 mm" },
    { keys: "PageUp PageDown", does: "On the canvas: the next curve" },
    { keys: "A, Insert", does: "On the canvas: add a point" },
    { keys: "Delete", does: "Remove the selected points" },
    { keys: "Escape", does: "Give up a drag, then the selection" },
    { keys: "Ctrl+A", does: "On the canvas: select all points" },
    { keys: "+ −", does: "On the canvas: zoom" },
    { keys: "F", does: "See everything", act: () => canvas.plot.fit() },
    { keys: "S", does: "Press or release at this speed", act: () => otherStroke(desk) },
    { keys: "P", does: "Pin the present state as before", act: () => pin(desk) },
    { keys: "B", does: "Show or hide what was before", act: () => desk.showBefore.update((on) => !on) },
    { keys: "C", does: "Go to the canvas", act: () => canvas.plot.element.focus() },
  );
}
