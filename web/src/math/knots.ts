/** Other knots for the same curve, or nearly: insert, add and remove a control point, refit. */

import { linspace } from "./arrays";
import { basis, findSpan, greville, multiplicity } from "./bspline";
import { forceAt_cN } from "./curve";
import { quadrature } from "./integral";
import { solve } from "./linear";
import { ModelError, type Numbers, type Spline } from "./types";

/** Nearer to a knot than this a place is taken for the knot, mm. */
export const NEAR_mm = 1e-9;

/** A curve on other knots, and how far it went from the one before. */
export interface Refitted extends Spline {
  readonly knots_mm: Float64Array;
  readonly control_points_cN: Float64Array;
  /** Largest change of force anywhere. */
  readonly largest_cN: number;
  /** Where it is. */
  readonly at_mm: number;
}

/** A curve with one control point more, of the same shape. */
export interface Added extends Spline {
  readonly knots_mm: Float64Array;
  readonly control_points_cN: Float64Array;
  /** Index of the control point nearest to the place asked for. */
  readonly index: number;
}

/** Insert one knot (Boehm): the shape stays, to rounding. Throws ModelError outside the curve. */
export function insertKnot(curve: Spline, x_mm: number): Omit<Added, "degree" | "index"> {
  const { knots_mm: t, control_points_cN: c, degree: k } = curve;
  if (!(x_mm > t[0]! && x_mm < t[t.length - 1]!)) {
    throw new ModelError(
      `a control point goes inside the curve, ${t[0]} to ${t[t.length - 1]} mm, got ${x_mm}`,
    );
  }
  const s = findSpan(t, k, x_mm);
  const knots = Float64Array.from([...Array.from(t).slice(0, s + 1), x_mm, ...Array.from(t).slice(s + 1)]);
  const points = new Float64Array(c.length + 1);
  for (let i = 0; i < points.length; i++) {
    if (i <= s - k) points[i] = c[i]!;
    else if (i > s) points[i] = c[i - 1]!;
    else {
      const part = (x_mm - t[i]!) / (t[i + k]! - t[i]!);
      points[i] = part * c[i]! + (1 - part) * c[i - 1]!;
    }
  }
  return { knots_mm: knots, control_points_cN: points };
}

/**
 * Add a control point at a place; the shape stays.
 *
 * A place that already holds a knot gets the new one in the middle of the longer span beside it, so that the
 * curve stays as smooth as it is. Throws ModelError outside the curve.
 */
export function addPoint(curve: Spline, x_mm: number): Added {
  const made = insertKnot(curve, clearOfKnots(curve.knots_mm, x_mm));
  const places = greville(made.knots_mm, curve.degree);
  let index = 0;
  for (let i = 1; i < places.length; i++) {
    if (Math.abs(places[i]! - x_mm) < Math.abs(places[index]! - x_mm)) index = i;
  }
  return { degree: curve.degree, ...made, index };
}

function clearOfKnots(t: Numbers, x: number): number {
  const knots = [...new Set(Array.from(t))];
  const near = knots.findIndex((knot) => Math.abs(knot - x) <= NEAR_mm);
  if (near <= 0 || near === knots.length - 1) return x;
  const [before, at, after] = [knots[near - 1]!, knots[near]!, knots[near + 1]!];
  return after - at >= at - before ? 0.5 * (at + after) : 0.5 * (before + at);
}

/**
 * Remove a control point with the least change of shape in least squares among the knots it rests on.
 *
 * Control points away from it, the ends among them, stay where they are. Throws ModelError if the curve has
 * no point to spare.
 */
export function removePoint(curve: Spline, index: number): Refitted {
  const k = curve.degree;
  const n = curve.control_points_cN.length;
  if (n <= k + 1)
    throw new ModelError(`degree ${k} needs at least ${k + 1} control points, the curve has no more`);
  const low = Math.min(Math.max(index + 1, k + 1), n - 1);
  const high = Math.max(Math.min(index + k, n - 1), low);
  let best: Refitted | null = null;
  let least = Infinity;
  for (let j = low; j <= high; j++) {
    const [found, error] = withoutKnot(curve, j);
    if (error < least) [best, least] = [found, error];
  }
  return best!;
}

/** Remove knot j; only the control points that inserting it again would move are free. */
function withoutKnot(curve: Spline, j: number): [Refitted, number] {
  const { degree: k, knots_mm: t, control_points_cN: c } = curve;
  const knots = Float64Array.from(t).filter((_, i) => i !== j);
  const s = findSpan(knots, k, t[j]!);
  const repeats = multiplicity(knots, t[j]!);
  const points = Float64Array.from(c).filter((_, i) => i !== j - 1);
  for (let i = 0; i < points.length; i++) points[i] = i <= s - k ? c[i]! : c[i + 1]!;
  return project(curve, k, knots, points, s - k + 1, s - repeats - 1);
}

/** Refit a curve on other knots of the same ends, in least squares over its length; its end forces stay. */
export function refit(curve: Spline, knots_mm: Numbers, degree = curve.degree): Refitted {
  const { control_points_cN: c } = curve;
  const n = knots_mm.length - degree - 1;
  const points = new Float64Array(n);
  [points[0], points[n - 1]] = [c[0]!, c[c.length - 1]!];
  return project(curve, degree, Float64Array.from(knots_mm), points, 1, n - 2)[0];
}

/** Find the free points (first to last) that minimise the integral of the squared difference to the curve. */
function project(
  curve: Spline,
  k: number,
  t: Float64Array,
  points: Float64Array,
  first: number,
  last: number,
): [Refitted, number] {
  const found = Float64Array.from(points);
  if (last >= first) {
    found.fill(0, first, last + 1);
    const { gram, right } = normalEquations(curve, k, t, found, first, last - first + 1);
    found.set(solve(gram, right), first);
  }
  return compared(curve, { degree: k, knots_mm: t, control_points_cN: found });
}

function normalEquations(
  curve: Spline,
  k: number,
  t: Float64Array,
  fixed: Float64Array,
  first: number,
  size: number,
) {
  const gram = Array.from({ length: size }, () => new Float64Array(size));
  const right = new Float64Array(size);
  const values = new Float64Array(k + 1);
  quadrature(breaksOf(curve.knots_mm, t), (x, weight) => {
    const rest = -gap_cN(curve, { degree: k, knots_mm: t, control_points_cN: fixed }, x);
    const i = findSpan(t, k, x);
    basis(t, k, i, x, values);
    for (let a = 0; a <= k; a++) {
      const row = i - k + a - first;
      if (row < 0 || row >= size) continue;
      right[row] = right[row]! + weight * values[a]! * rest;
      for (let b = 0; b <= k; b++) {
        const column = i - k + b - first;
        if (column >= 0 && column < size)
          gram[row]![column] = gram[row]![column]! + weight * values[a]! * values[b]!;
      }
    }
  });
  return { gram, right };
}

function breaksOf(a: Numbers, b: Numbers): number[] {
  return [...new Set([...Array.from(a), ...Array.from(b)])].sort((x, y) => x - y);
}

/** How far two curves are apart: largest and where, and the integral of the square. */
function compared(before: Spline, after: Omit<Refitted, "largest_cN" | "at_mm">): [Refitted, number] {
  let error = 0;
  let [largest, at] = [0, before.knots_mm[0]!];
  const breaks = breaksOf(before.knots_mm, after.knots_mm);
  quadrature(breaks, (x, weight) => {
    error += weight * gap_cN(before, after, x) ** 2;
  });
  for (let i = 1; i < breaks.length; i++) {
    for (const x of linspace(breaks[i - 1]!, breaks[i]!, 17)) {
      const gap = Math.abs(gap_cN(before, after, x));
      if (gap > largest) [largest, at] = [gap, x];
    }
  }
  return [{ ...after, largest_cN: largest, at_mm: at }, error];
}

function gap_cN(a: Spline, b: Spline, x: number): number {
  return forceAt_cN(b, x) - forceAt_cN(a, x);
}
