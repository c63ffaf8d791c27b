/** How curves differ; the grid and the range are those of `fdvv.workflow.compare`. */

import { linspace, roundHalfEven } from "./arrays";
import { end_mm, force_cN, start_mm } from "./curve";
import { type ButtonLike, ModelError, type Spline, type Stroke } from "./types";
import { blendOf, nearest } from "./velocity";

/** Differences are read at this step. */
const DIFFERENCE_STEP_mm = 0.01;

/** Force of one curve less that of the reference, over the displacement that both have. */
export interface Difference {
  readonly rms_cN: number;
  readonly mean_cN: number;
  /** Greatest absolute value. */
  readonly max_cN: number;
  /** Where it is. */
  readonly max_mm: number;
  readonly from_mm: number;
  readonly to_mm: number;
}

/** Compare two curves. Throws ModelError if they share no displacement. */
export function differences(reference: Spline, other: Spline): Difference {
  const x = common(reference, other);
  if (!x) throw new ModelError("the two curves share no displacement");
  return summed(x, force_cN(reference, x), force_cN(other, x));
}

/**
 * Compare one stroke of two buttons at a velocity, the slowest of each by default; between measured velocities
 * each button blends as it does. null if either has no such curve or they share no displacement.
 */
export function buttonDifference(
  reference: ButtonLike,
  other: ButtonLike,
  stroke: Stroke,
  velocity_mm_s: number | null = null,
): Difference | null {
  const [mine, theirs] = [nearest(reference, stroke, velocity_mm_s), nearest(other, stroke, velocity_mm_s)];
  const x = mine && theirs && common(mine, theirs);
  if (!x) return null;
  const base = blendOf(reference, stroke, x).at(velocity_mm_s || mine.velocity_mm_s || 1);
  return summed(x, base, blendOf(other, stroke, x).at(velocity_mm_s || theirs.velocity_mm_s || 1));
}

function common(a: Spline, b: Spline): Float64Array | null {
  const low = Math.max(start_mm(a), start_mm(b));
  const high = Math.min(end_mm(a), end_mm(b));
  if (high <= low) return null;
  return linspace(low, high, Math.max(2, roundHalfEven((high - low) / DIFFERENCE_STEP_mm) + 1));
}

function summed(x: Float64Array, base: Float64Array, other: Float64Array): Difference {
  let [sum, squares, at] = [0, 0, 0];
  for (let i = 0; i < x.length; i++) {
    const delta = other[i]! - base[i]!;
    sum += delta;
    squares += delta * delta;
    if (Math.abs(delta) > Math.abs(other[at]! - base[at]!)) at = i;
  }
  return {
    rms_cN: Math.sqrt(squares / x.length),
    mean_cN: sum / x.length,
    max_cN: Math.abs(other[at]! - base[at]!),
    max_mm: x[at]!,
    from_mm: x[0]!,
    to_mm: x[x.length - 1]!,
  };
}
