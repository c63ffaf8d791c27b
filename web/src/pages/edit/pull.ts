/** How much each control point lifts a place of a curve. */

import { basis, findSpan, type Spline } from "../../math";

/** Index and weight of the control points that move a curve at a place; the weights sum to 1. */
export function basisAt(curve: Spline, x_mm: number): (readonly [number, number])[] {
  const { degree: k, knots_mm: t } = curve;
  const span = findSpan(t, k, x_mm);
  const values = new Float64Array(k + 1);
  basis(t, k, span, x_mm, values);
  return Array.from(values, (weight, i) => [span - k + i, weight] as const).filter(([, weight]) => weight > 0);
}
