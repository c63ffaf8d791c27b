/** Edits of the selected control points that keys, buttons and tables share. */

import { addPoint, removePoint, together } from "../../model";
import { controlPoints_mm } from "../../math";
import { type Desk, refOf } from "./desk";

/** Remove the selected control points as one step; the shape changes as little as it can. */
export function removeSelected(desk: Desk): void {
  const rows = [...desk.selection.peek()].sort((a, b) => b - a);
  if (!rows.length) return;
  const at = refOf(desk.curve());
  const what = rows.length === 1 ? "remove a point" : `remove ${rows.length} points`;
  if (desk.apply(together(what, rows.map((row) => removePoint(at, row))))) desk.selection.set([]);
}

/** Add a control point to the active curve and select it; the shape stays. */
export function addAt(desk: Desk, x_mm: number): void {
  if (!desk.apply(addPoint(refOf(desk.curve()), x_mm))) return;
  const places = controlPoints_mm(desk.curve());
  let nearest = 0;
  places.forEach((at, i) => {
    if (Math.abs(at - x_mm) < Math.abs(places[nearest]! - x_mm)) nearest = i;
  });
  desk.selection.set([nearest]);
}
