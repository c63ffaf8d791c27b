/**
 * Clamped B-splines: evaluation, derivative, places of control points.
 *
 * Notation as in `fdvv.model._bspline`: t knots (n + k + 1), c coefficients (n), k degree, x abscissae. The
 * recurrence is de Boor's (A Practical Guide to Splines, ch. IX and X).
 */

import { ModelError, type Numbers } from "./types";

const LARGEST_DEGREE = 5;

/** Refuse what is no clamped spline of degree 1 to 5. Throws ModelError. */
export function checkSpline(t: Numbers, c: Numbers, k: number): void {
  const n = c.length;
  if (!(Number.isInteger(k) && k >= 1 && k <= LARGEST_DEGREE)) {
    throw new ModelError(`degree must be 1 to 5, got ${k}`);
  }
  if (n < k + 1) throw new ModelError(`degree ${k} needs at least ${k + 1} control points, got ${n}`);
  if (t.length !== n + k + 1) {
    throw new ModelError(`${n} control points of degree ${k} need ${n + k + 1} knots, got ${t.length}`);
  }
  for (let i = 1; i < t.length; i++) {
    if (t[i]! < t[i - 1]!) throw new ModelError("knots_mm must not fall");
  }
  if (t[0] !== t[k] || t[n] !== t[n + k]) {
    throw new ModelError(`the first and last ${k + 1} knots must be equal`);
  }
  for (let i = 0; i < n; i++) {
    if (t[i + k + 1]! <= t[i]!) {
      throw new ModelError(`no knot may repeat more than ${k + 1} times and the curve needs a length`);
    }
  }
}

/** Make clamped knots with equal spans for n coefficients of degree k. */
export function uniformKnots(start: number, end: number, n: number, k: number): Float64Array {
  const t = new Float64Array(n + k + 1).fill(start, 0, k + 1).fill(end, n);
  const spans = n - k;
  for (let i = 1; i < spans; i++) t[k + i] = start + i * ((end - start) / spans);
  return t;
}

/** Average k successive knots: the abscissa at which each control point acts, (n). */
export function greville(t: Numbers, k: number): Float64Array {
  const out = new Float64Array(t.length - k - 1);
  for (let i = 0; i < out.length; i++) {
    let sum = 0;
    for (let j = 1; j <= k; j++) sum += t[i + j]!;
    out[i] = sum / k;
  }
  return out;
}

/** Find i with t[i] <= x < t[i + 1], the last such span at the end; begun at a guess, for rows of x. */
export function findSpan(t: Numbers, k: number, x: number, guess = k): number {
  const last = t.length - k - 2;
  let i = guess;
  while (i > k && x < t[i]!) i--;
  while (i < last && x >= t[i + 1]!) i++;
  return i;
}

const triangle = new Float64Array(LARGEST_DEGREE + 1);

/** Run de Boor's recurrence of degree k over the values in `triangle`, which belong to span i of t. */
function recur(t: Numbers, i: number, k: number, x: number): number {
  for (let r = 1; r <= k; r++) {
    for (let j = k; j >= r; j--) {
      const low = t[i - k + j]!;
      const part = (x - low) / (t[i + 1 + j - r]! - low);
      triangle[j] = (1 - part) * triangle[j - 1]! + part * triangle[j]!;
    }
  }
  return triangle[k]!;
}

function valueAt(t: Numbers, c: Numbers, k: number, i: number, x: number): number {
  for (let j = 0; j <= k; j++) triangle[j] = c[i - k + j]!;
  return recur(t, i, k, x);
}

/** The derivative is a spline of degree k - 1 whose coefficients are differences of c over the same knots. */
function slopeAt(t: Numbers, c: Numbers, k: number, i: number, x: number): number {
  for (let j = 0; j < k; j++) {
    const m = i - k + 1 + j;
    triangle[j] = (k * (c[m]! - c[m - 1]!)) / (t[m + k]! - t[m]!);
  }
  return recur(t, i, k - 1, x);
}

/**
 * Evaluate a spline, or its derivative, at many x, in any order.
 *
 * Outside the knots the end values hold, with derivative 0. `out` takes the values, where given, without
 * allocation; it is at least as long as x.
 */
export function evaluate(
  t: Numbers,
  c: Numbers,
  k: number,
  x: Numbers,
  derivative: 0 | 1 = 0,
  out: Float64Array = new Float64Array(x.length),
): Float64Array {
  const start = t[0]!;
  const end = t[t.length - 1]!;
  let i = k;
  for (let m = 0; m < x.length; m++) {
    const at = x[m]!;
    const inside = at < start ? start : Math.min(at, end);
    i = findSpan(t, k, inside, i);
    if (!derivative) out[m] = valueAt(t, c, k, i, inside);
    else out[m] = inside === at ? slopeAt(t, c, k, i, inside) : 0;
  }
  return out;
}

/** Evaluate the k + 1 basis functions that are not zero at x in span i; the first is number i - k. */
export function basis(
  t: Numbers,
  k: number,
  i: number,
  x: number,
  out = new Float64Array(k + 1),
): Float64Array {
  out[0] = 1;
  for (let r = 1; r <= k; r++) {
    let carried = 0;
    for (let j = 0; j < r; j++) {
      const right = t[i + 1 + j]!;
      const left = t[i + 1 + j - r]!;
      const share = out[j]! / (right - left);
      out[j] = carried + (right - x) * share;
      carried = (x - left) * share;
    }
    out[r] = carried;
  }
  return out;
}

/** Count how often x stands among the knots. */
export function multiplicity(t: Numbers, x: number): number {
  let count = 0;
  for (let i = 0; i < t.length; i++) if (t[i] === x) count++;
  return count;
}
