/** The bump of a tactile curve: its peak, its valley and the drop; mirrors `fdvv.model._bump`. */

import type { Numbers } from "./types";

/** A smaller drop is friction, not a bump. */
export const LEAST_DROP_cN = 4;

/** Forces of peak and valley are means over this length. */
const RESOLUTION_mm = 0.05;

/** The largest fall of force with displacement. */
export interface Bump {
  readonly peak_mm: number;
  readonly peak_cN: number;
  readonly valley_mm: number;
  readonly valley_cN: number;
}

/** Return the fall from peak to valley. */
export function drop_cN(bump: Bump): number {
  return bump.peak_cN - bump.valley_cN;
}

/** Return (peak - valley) / peak, the click ratio of switch data sheets. */
export function snapRatio(bump: Bump): number {
  return drop_cN(bump) / bump.peak_cN;
}

/**
 * Find the largest fall of force along strictly rising displacement; null if it is less than least_drop_cN.
 *
 * It is the greatest difference between a running maximum and a later value, so that texture on the flanks
 * does not cut a bump in two.
 */
export function findBump(x_mm: Numbers, force_cN: Numbers, least_drop_cN = LEAST_DROP_cN): Bump | null {
  const force = runningMean(x_mm, force_cN, RESOLUTION_mm);
  let [peak, valley, highest, deepest] = [0, 0, 0, 0];
  for (let i = 1; i < force.length; i++) {
    if (force[i]! > force[highest]!) highest = i;
    const fall = force[highest]! - force[i]!;
    if (fall > deepest) [peak, valley, deepest] = [highest, i, fall];
  }
  const bump = {
    peak_mm: x_mm[peak]!,
    peak_cN: force[peak]!,
    valley_mm: x_mm[valley]!,
    valley_cN: force[valley]!,
  };
  return drop_cN(bump) >= least_drop_cN ? bump : null;
}

/** Average the polyline through (x, force) over width_mm around each point, less at the ends. */
export function runningMean(x_mm: Numbers, force_cN: Numbers, width_mm: number): Float64Array {
  const n = x_mm.length;
  const area = new Float64Array(n);
  for (let i = 1; i < n; i++) {
    area[i] = area[i - 1]! + 0.5 * (force_cN[i]! + force_cN[i - 1]!) * (x_mm[i]! - x_mm[i - 1]!);
  }
  const mean = Float64Array.from(force_cN);
  let [below, above] = [0, 0];
  for (let i = 0; i < n; i++) {
    const x = x_mm[i]!;
    const reach = Math.min(0.5 * width_mm, x - x_mm[0]!, x_mm[n - 1]! - x);
    if (reach <= 0) continue;
    const [low, high] = [x - reach, x + reach];
    while (below < n - 2 && x_mm[below + 1]! <= low) below++;
    while (below > 0 && x_mm[below]! > low) below--;
    while (above < n - 2 && x_mm[above + 1]! <= high) above++;
    while (above > 0 && x_mm[above]! > high) above--;
    mean[i] = (areaTo(high, above) - areaTo(low, below)) / (high - low);
  }
  return mean;

  /** Integrate the polyline from its start to a place in span k, exactly. */
  function areaTo(at: number, k: number): number {
    const part = at - x_mm[k]!;
    const slope = (force_cN[k + 1]! - force_cN[k]!) / (x_mm[k + 1]! - x_mm[k]!);
    return area[k]! + part * (force_cN[k]! + 0.5 * slope * part);
  }
}
