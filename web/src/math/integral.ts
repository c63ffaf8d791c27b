/** Integrals of splines, exact: the quadrature's order covers the degree. */

import { basis, findSpan } from "./bspline";
import type { Numbers, Spline } from "./types";

/** Gauss-Legendre on -1 to 1 with 3 points (exact to degree 5) and 6 (to degree 11, products of two splines). */
const THREE: readonly (readonly [number, number])[] = [
  [-Math.sqrt(3 / 5), 5 / 9],
  [0, 8 / 9],
  [Math.sqrt(3 / 5), 5 / 9],
];
const SIX: readonly (readonly [number, number])[] = [
  [-0.9324695142031521, 0.1713244923791704],
  [-0.6612093864662645, 0.3607615730481386],
  [-0.2386191860831969, 0.467913934572691],
  [0.2386191860831969, 0.467913934572691],
  [0.6612093864662645, 0.3607615730481386],
  [0.9324695142031521, 0.1713244923791704],
];

/** Visit places and weights that integrate a product of two splines with breaks at these knots. */
export function quadrature(breaks: Numbers, visit: (x: number, weight: number) => void, of = SIX): void {
  for (let i = 1; i < breaks.length; i++) {
    const half = 0.5 * (breaks[i]! - breaks[i - 1]!);
    if (half <= 0) continue;
    const middle = 0.5 * (breaks[i]! + breaks[i - 1]!);
    for (const [place, weight] of of) visit(middle + half * place, half * weight);
  }
}

/**
 * Return the weights w with which a curve's integral from a to b (cN mm) is the sum of w times its control points.
 *
 * Outside the knots the end values hold, as in force_cN.
 */
export function integralWeights(curve: Spline, a_mm: number, b_mm: number): Float64Array {
  const { knots_mm: t, degree: k } = curve;
  const weights = new Float64Array(t.length - k - 1);
  const [start, end] = [t[0]!, t[t.length - 1]!];
  const inner = Array.from(t).filter((x) => x > a_mm && x < b_mm);
  const values = new Float64Array(k + 1);
  quadrature([Math.max(a_mm, start), ...inner, Math.min(b_mm, end)], add, THREE);
  weights[0] = weights[0]! + Math.max(0, Math.min(b_mm, start) - a_mm);
  const last = weights.length - 1;
  weights[last] = weights[last]! + Math.max(0, b_mm - Math.max(a_mm, end));
  return weights;

  function add(x: number, weight: number): void {
    const i = findSpan(t, k, x);
    basis(t, k, i, x, values);
    for (let j = 0; j <= k; j++) weights[i - k + j] = weights[i - k + j]! + weight * values[j]!;
  }
}

/** Integrate a curve from a to b, cN mm, exactly. */
export function integral_cN_mm(curve: Spline, a_mm: number, b_mm: number): number {
  const weights = integralWeights(curve, a_mm, b_mm);
  let sum = 0;
  for (let i = 0; i < weights.length; i++) sum += weights[i]! * curve.control_points_cN[i]!;
  return sum;
}
