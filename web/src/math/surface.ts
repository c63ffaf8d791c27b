/** Force on a grid of displacement and velocity: what a 3D view draws. */

import { linspace } from "./arrays";
import type { ButtonLike, Numbers, Stroke } from "./types";
import { blendOf, curvesOf } from "./velocity";

/** Force of one stroke on a grid. */
export interface Surface {
  readonly stroke: Stroke;
  readonly displacement_mm: Float64Array;
  readonly velocity_mm_s: Float64Array;
  /** Row after row, one row a velocity. */
  readonly force_cN: Float64Array;
}

/** Sample a stroke; its rows are the velocities. Throws ModelError if the button has no such curve. */
export function surface(
  button: ButtonLike,
  stroke: Stroke,
  velocity_mm_s: Numbers,
  displacement_mm: Numbers,
): Surface {
  const x = Float64Array.from(displacement_mm);
  const v = Float64Array.from(velocity_mm_s);
  const force = new Float64Array(x.length * v.length);
  const made = blendOf(button, stroke, x);
  v.forEach((velocity, i) => made.at(velocity, force.subarray(i * x.length, (i + 1) * x.length)));
  return { stroke, displacement_mm: x, velocity_mm_s: v, force_cN: force };
}

/** Return displacements over the travel and velocities over what was measured, for a view of rows x columns. */
export function surfaceGrid(
  button: ButtonLike,
  stroke: Stroke,
  rows: number,
  columns: number,
): [Float64Array, Float64Array] {
  const known = curvesOf(button, stroke).flatMap((c) => (c.velocity_mm_s === null ? [] : [c.velocity_mm_s]));
  const [slow, fast] = known.length ? [known[0]!, known[known.length - 1]!] : [1, 1];
  return [linspace(slow, fast, fast > slow ? rows : 1), linspace(0, button.travel_mm, columns)];
}
