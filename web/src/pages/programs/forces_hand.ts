/** Points of a line of forces under pointer and keys. */

import type { Plot } from "../../draw";
import type { Surface } from "../../programs/document";
import { replaceSurface } from "../../programs/edits_parts";
import { pulledSurface } from "../../programs/surface";
import { followPointer } from "../../ui";
import type { PointEdits } from "./forces_edits";
import { nearestHandle } from "./forces_points";

const NEAR_px = 22;

/** Let points be dragged on a plot. pulling: called with true on drag start, with false on release. */
export function pullByHand(plot: Plot, edits: PointEdits, pulling: (on: boolean) => void): void {
  const { element } = plot;
  element.addEventListener("pointerdown", (event) => {
    const surface = edits.surface();
    if (event.button !== 0 || !surface) return;
    const column = nearestHandle(surface, edits.row, plot.view(), plot.at(event), NEAR_px);
    if (column === null) return;
    event.preventDefault();
    element.focus();
    edits.editing.column.set(column);
    pull(plot, edits, event, surface, pulling);
  });
  element.addEventListener("keydown", (event) => {
    if (event.target === element && key(edits, event)) event.preventDefault();
  });
  element.addEventListener("dblclick", (event) => edits.add(Number(plot.at(event).x.toFixed(3))));
}

function pull(
  plot: Plot,
  edits: PointEdits,
  event: PointerEvent,
  surface: Surface,
  pulling: (on: boolean) => void,
): void {
  const { book, row, column, reach_mm } = edits;
  const [begin, first_cN] = [plot.at(event), surface.force_cN[row]![column]!];
  pulling(true);
  book.mark("pull a point");
  const move = (now: PointerEvent): void => {
    const force_cN = Number((first_cN + plot.at(now).y - begin.y).toFixed(1));
    const pulled = pulledSurface(surface, row, column, force_cN, reach_mm);
    book.drag((before) => replaceSurface(before, surface.name, pulled));
  };
  followPointer(plot.element, event, move, (kept) => {
    pulling(false);
    if (kept) book.release();
    else book.cancel();
  });
}

/** Do what a key means; tell whether it meant anything. */
function key(edits: PointEdits, event: KeyboardEvent): boolean {
  const surface = edits.surface();
  if (!surface || event.ctrlKey || event.metaKey) return false;
  const by = event.key === "ArrowUp" ? 1 : event.key === "ArrowDown" ? -1 : 0;
  const step_cN = event.shiftKey ? 10 : event.altKey ? 0.1 : 1;
  if (by) edits.pull(surface.force_cN[edits.row]![edits.column]! + by * step_cN);
  else if (event.key === "ArrowLeft") edits.step(-1);
  else if (event.key === "ArrowRight") edits.step(1);
  else if (event.key === "Delete") edits.remove();
  else if (event.key === "Insert") edits.addBehind();
  else return false;
  return true;
}
