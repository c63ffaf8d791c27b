/**
 * Constraints of editing, as pure functions on control points.
 *
 * A B-spline whose control points do not fall does not fall either, so monotone is asked of the points. The
 * integral is linear in the points, so that keeping the work is one condition on them.
 */

import type { Numbers } from "./types";

/** What an edit has to respect; what is left out does not bind. */
export interface Constraints {
  /** Keep the curve from falling, or from rising. */
  readonly monotone?: "rising" | "falling";
  /** Keep the integral over the travel, by shifting the points that were not taken hold of. */
  readonly keepWork?: boolean;
  /** Keep the first and the last control point, the forces at the ends. */
  readonly keepEnds?: boolean;
  /** Round what was taken hold of to multiples of this. */
  readonly step_cN?: number;
  readonly least_cN?: number;
  readonly most_cN?: number;
}

/** The condition that the sum of weights times control points is a number. */
export interface Work {
  readonly weights: Numbers;
  readonly wanted: number;
}

/** Round to the nearest multiple of a step; a step of 0 leaves the value. */
export function snap(value: number, step: number): number {
  // by the inverse of a decimal step a multiple comes out as people write it
  const inverse = 1 / step;
  const whole = Math.abs(inverse - Math.round(inverse)) < 1e-9 * inverse;
  if (!(step > 0)) return value;
  return (whole ? Math.round(value * inverse) / Math.round(inverse) : Math.round(value / step) * step) + 0;
}

/** Keep a value between limits. */
export function limit(value: number, least = -Infinity, most = Infinity): number {
  return Math.min(Math.max(value, least), most);
}

/**
 * Find the nearest control points (least squares) that do not fall, the held ones at their values.
 *
 * Pool adjacent violators between the held points, then bounded by them, which is the exact projection. Held
 * points that contradict each other are first projected among themselves.
 */
export function monotone(
  c: Numbers,
  held: ReadonlySet<number> = new Set(),
  way: "rising" | "falling" = "rising",
): Float64Array {
  const sign = way === "rising" ? 1 : -1;
  const y = Float64Array.from(c, (value) => sign * value);
  const fixed = [...held].filter((i) => i >= 0 && i < y.length).sort((a, b) => a - b);
  pooled(Float64Array.from(fixed, (i) => y[i]!)).forEach((value, j) => {
    y[fixed[j]!] = value;
  });
  const bounds = [-1, ...fixed, y.length];
  for (let j = 1; j < bounds.length; j++) {
    const [from, to] = [bounds[j - 1]! + 1, bounds[j]!];
    const [least, most] = [from > 0 ? y[from - 1]! : -Infinity, to < y.length ? y[to]! : Infinity];
    y.set(
      pooled(y.subarray(from, to)).map((value) => limit(value, least, most)),
      from,
    );
  }
  return y.map((value) => sign * value + 0);
}

/** Isotonic regression: each run of violators takes its mean. */
function pooled(y: Float64Array): Float64Array {
  const mean: number[] = [];
  const count: number[] = [];
  for (const value of y) {
    mean.push(value);
    count.push(1);
    while (mean.length > 1 && mean[mean.length - 2]! > mean[mean.length - 1]!) {
      const [m, n] = [mean.pop()!, count.pop()!];
      const last = mean.length - 1;
      mean[last] = (mean[last]! * count[last]! + m * n) / (count[last]! + n);
      count[last] = count[last]! + n;
    }
  }
  return Float64Array.from(mean.flatMap((m, i) => Array<number>(count[i]!).fill(m)));
}

/** Shift the points that are not held by the smallest change (least squares) that makes the sum as wanted. */
export function keepWork(c: Numbers, work: Work, held: ReadonlySet<number> = new Set()): Float64Array {
  const free = freeWeights(work.weights, held);
  return shifted(c, free, (work.wanted - sum(work.weights, c)) / (sum(free, free) || 1));
}

function freeWeights(weights: Numbers, held: ReadonlySet<number>): Float64Array {
  return Float64Array.from(weights, (w, i) => (held.has(i) ? 0 : w));
}

function shifted(c: Numbers, weights: Numbers, by: number): Float64Array {
  return Float64Array.from(c, (value, i) => value + by * weights[i]!);
}

function sum(a: Numbers, b: Numbers): number {
  let total = 0;
  for (let i = 0; i < a.length; i++) total += a[i]! * b[i]!;
  return total;
}

/**
 * Find the control points nearest (least squares) to what an edit asks for that respect the constraints.
 *
 * before : the control points until now; wanted : what the edit asks for; held : the points taken hold of,
 * which stay where they are wanted (snapped, within limits). work : needed for keepWork. Where limits or monotone
 * leave no way to keep the work, it comes as near as they let it.
 */
export function constrain(
  before: Numbers,
  wanted: Numbers,
  held: ReadonlySet<number>,
  constraints: Constraints,
  work?: Work,
): Float64Array {
  const { step_cN: step = 0, least_cN: least, most_cN: most } = constraints;
  const fixed = new Set(held);
  const asked = Float64Array.from(wanted, (value, i) =>
    held.has(i) ? limit(snap(value, step), least, most) : value,
  );
  if (constraints.keepEnds) {
    for (const end of [0, asked.length - 1]) {
      asked[end] = before[end]!;
      fixed.add(end);
    }
  }
  const settle = (c: Float64Array): Float64Array => {
    const shaped = constraints.monotone ? monotone(c, fixed, constraints.monotone) : c;
    return shaped.map((value, i) => (fixed.has(i) ? value : limit(value, least, most)));
  };
  return constraints.keepWork && work ? settledAtWork(asked, fixed, work, settle) : settle(asked);
}

/**
 * Keep the work and the other constraints at once: by the conditions of Karush, Kuhn and Tucker the answer is
 * the projection of the points shifted along the weights, and its work never falls with the shift.
 */
function settledAtWork(
  asked: Float64Array,
  fixed: ReadonlySet<number>,
  work: Work,
  settle: (c: Float64Array) => Float64Array,
): Float64Array {
  const free = freeWeights(work.weights, fixed);
  const squared = sum(free, free);
  const at = (by: number) => settle(shifted(asked, free, by));
  const missing = (by: number) => work.wanted - sum(work.weights, at(by));
  const rest = missing(0);
  if (!squared || rest === 0) return at(0);
  let reach = rest / squared;
  for (let i = 0; i < 60 && missing(reach) * rest > 0; i++) reach *= 2;
  return at(root(missing, 0, reach));
}

/** Find where a monotone, piecewise linear function is zero, between places where its signs differ. */
function root(f: (x: number) => number, from: number, to: number): number {
  let [a, b, fa, fb] = [from, to, f(from), f(to)];
  for (let i = 0; i < 100 && fa * fb < 0; i++) {
    // chords end on the right piece at once, halving gets there from afar
    const x = i % 3 === 2 ? 0.5 * (a + b) : b - (fb * (b - a)) / (fb - fa);
    const fx = f(x);
    if (x === a || x === b) break;
    if (fx * fa > 0) [a, fa] = [x, fx];
    else [b, fb] = [x, fx];
  }
  return Math.abs(fa) < Math.abs(fb) ? a : b;
}
