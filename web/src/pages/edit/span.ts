/** The part of the travel that the selected control points stand on. */

import { controlPoints_mm } from "../../math";
import type { Desk, Span } from "./desk";

/** From the first to the last selected point; the middle third of the curve if fewer than two are selected. */
export function spanOfSelection(desk: Desk): Span {
  const places = controlPoints_mm(desk.curve());
  const selected = desk.selection.peek();
  const [first, last] = selected.length > 1 ? [selected[0]!, selected.at(-1)!] : [Math.floor(places.length / 3), Math.ceil((2 * places.length) / 3)];
  const round = (x: number) => Number(x.toFixed(3));
  return { from_mm: round(places[first]!), to_mm: round(places[last]!) };
}
