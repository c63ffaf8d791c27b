/** Which points of a surface can be pulled: all of a few, some of many. */

import type { View } from "../../draw";
import type { Surface } from "../../programs/document";

const MOST = 26;

/** Return the columns that have a handle, first and last included. */
export function handlesOf(surface: Surface): readonly number[] {
  const count = surface.displacement_mm.length;
  const shown = Math.min(count, MOST);
  return Array.from({ length: shown }, (_, i) => Math.round((i * (count - 1)) / Math.max(1, shown - 1)));
}

/** Find the handle nearest to a place on the screen, within some pixels; null if there is none. */
export function nearestHandle(
  surface: Surface,
  row: number,
  view: View,
  at: { readonly x_px: number; readonly y_px: number },
  within_px: number,
): number | null {
  const far = (column: number): number =>
    Math.hypot(
      view.x.px(surface.displacement_mm[column]!) - at.x_px,
      view.y.px(surface.force_cN[row]![column]!) - at.y_px,
    );
  const [best] = handlesOf(surface)
    .map((column) => ({ column, far_px: far(column) }))
    .sort((a, b) => a.far_px - b.far_px);
  return best && best.far_px <= within_px ? best.column : null;
}
