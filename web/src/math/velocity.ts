/**
 * Force between the measured velocities; mirrors `fdvv.model._velocity`.
 *
 * Notation: v the measured velocities, h their steps, y (n rows) what the curves say at the displacements, m the
 * slopes over velocity.
 */

import { firstAbove } from "./arrays";
import { force_cN, stiffness_cN_mm } from "./curve";
import {
  type ButtonLike,
  type CurveLike,
  type Interpolation,
  ModelError,
  type Numbers,
  type Stroke,
} from "./types";

/** Force, or its derivative over displacement, at fixed displacements and any velocity. */
export interface Blend {
  /** Return the values at a velocity, into `out` where given. */
  at(velocity_mm_s: number, out?: Float64Array): Float64Array;
  /** Return the derivative over velocity; 0 beyond the measured velocities. */
  slopeAt(velocity_mm_s: number, out?: Float64Array): Float64Array;
}

interface Place {
  readonly lower: number;
  readonly part: number;
  readonly h: number;
  readonly outside: boolean;
}

/**
 * Prepare the curves of one stroke at fixed displacements, once for many velocities.
 *
 * curves : velocities rising; a single curve serves every velocity. At a measured velocity the result is that
 * curve's, to the bit. derivative 1 gives dF/dx.
 */
export function blend(
  curves: readonly CurveLike[],
  method: Interpolation,
  x_mm: Numbers,
  derivative: 0 | 1 = 0,
): Blend {
  const read = derivative ? stiffness_cN_mm : force_cN;
  const y = curves.map((curve) => read(curve, x_mm));
  if (curves.length === 1) return constant(y[0]!);
  const v = curves.map((curve) => curve.velocity_mm_s!);
  const cubic = method === "pchip" && curves.length > 2;
  const m = cubic ? slopes(v, derivative ? curves.map((c) => force_cN(c, x_mm)) : y, y) : null;
  const made = (out?: Float64Array) => out ?? new Float64Array(x_mm.length);
  return {
    at: (velocity, out) => valuesAt(locate(v, velocity), y, m, method, made(out)),
    slopeAt: (velocity, out) => slopesAt(locate(v, velocity), y, m, method, made(out)),
  };
}

function constant(row: Float64Array): Blend {
  return {
    at: (_, out) => {
      if (!out) return row.slice();
      out.set(row);
      return out;
    },
    slopeAt: (_, out) => (out ?? new Float64Array(row.length)).fill(0),
  };
}

/** Find the two measured velocities around the wanted one, held at the ends. */
function locate(v: readonly number[], wanted: number): Place {
  const held = Math.min(Math.max(wanted, v[0]!), v[v.length - 1]!);
  const lower = Math.min(Math.max(firstAbove(v, held) - 1, 0), v.length - 2);
  const h = v[lower + 1]! - v[lower]!;
  return { lower, part: (held - v[lower]!) / h, h, outside: held !== wanted };
}

function valuesAt(
  at: Place,
  y: Float64Array[],
  m: Float64Array[] | null,
  method: Interpolation,
  out: Float64Array,
) {
  const { lower, part: s, h } = at;
  if (method === "nearest") {
    out.set(y[lower + (s > 0.5 ? 1 : 0)]!);
    return out;
  }
  const [low, high] = [y[lower]!, y[lower + 1]!];
  if (!m) {
    for (let i = 0; i < out.length; i++) out[i] = (1 - s) * low[i]! + s * high[i]!;
    return out;
  }
  const [m0, m1] = [m[lower]!, m[lower + 1]!];
  const [a, b, bend] = [(1 - s) ** 2 * (1 + 2 * s), s ** 2 * (3 - 2 * s), s * (1 - s) * h];
  for (let i = 0; i < out.length; i++) {
    out[i] = a * low[i]! + b * high[i]! + bend * ((1 - s) * m0[i]! - s * m1[i]!);
  }
  return out;
}

function slopesAt(
  at: Place,
  y: Float64Array[],
  m: Float64Array[] | null,
  method: Interpolation,
  out: Float64Array,
) {
  const { lower, part: s, h } = at;
  if (at.outside || method === "nearest") return out.fill(0);
  const [low, high] = [y[lower]!, y[lower + 1]!];
  for (let i = 0; i < out.length; i++) {
    const secant = (high[i]! - low[i]!) / h;
    out[i] = m
      ? 6 * s * (1 - s) * secant + (1 - s) * (1 - 3 * s) * m[lower]![i]! + s * (3 * s - 2) * m[lower + 1]![i]!
      : secant;
  }
  return out;
}

/**
 * Return the PCHIP slopes over velocity, one row per curve, for 3 curves or more (Fritsch and Butland, SIAM J.
 * Sci. Stat. Comput. 5, 1984).
 *
 * They are homogeneous in the secants of force, so by Euler their partial derivatives weigh the secants of
 * y = dF/dx into the slopes' own derivative over x.
 */
function slopes(v: readonly number[], force: Float64Array[], y: Float64Array[]): Float64Array[] {
  const n = v.length;
  const size = y[0]!.length;
  const h = v.slice(1).map((after, i) => after - v[i]!);
  const m = v.map(() => new Float64Array(size));
  const d = new Float64Array(n - 1);
  const of = new Float64Array(n - 1);
  for (let p = 0; p < size; p++) {
    for (let i = 0; i < n - 1; i++) {
      d[i] = (force[i + 1]![p]! - force[i]![p]!) / h[i]!;
      of[i] = (y[i + 1]![p]! - y[i]![p]!) / h[i]!;
    }
    m[0]![p] = endSlope(h[0]!, h[1]!, d[0]!, d[1]!, of[0]!, of[1]!);
    for (let i = 1; i < n - 1; i++)
      m[i]![p] = innerSlope(h[i - 1]!, h[i]!, d[i - 1]!, d[i]!, of[i - 1]!, of[i]!);
    m[n - 1]![p] = endSlope(h[n - 2]!, h[n - 3]!, d[n - 2]!, d[n - 3]!, of[n - 2]!, of[n - 3]!);
  }
  return m;
}

/** Weighted harmonic mean of the secants beside a velocity; 0 where they differ in sign. */
function innerSlope(h0: number, h1: number, d0: number, d1: number, of0: number, of1: number): number {
  if (!(d0 * d1 > 0)) return 0;
  const [w1, w2] = [h0 + 2 * h1, 2 * h0 + h1];
  const total = w1 * d1 + w2 * d0;
  return (w1 + w2) * (w1 * (d1 / total) ** 2 * of0 + w2 * (d0 / total) ** 2 * of1);
}

/** Slope at an end: of the parabola through three curves, bounded to stay monotone. */
function endSlope(h0: number, h1: number, d0: number, d1: number, of0: number, of1: number): number {
  const far = h0 / (h0 + h1);
  const slope = (1 + far) * d0 - far * d1;
  if (slope * d0 <= 0) return 0;
  const steep = d0 * d1 < 0 && Math.abs(slope) > 3 * Math.abs(d0);
  return steep ? 3 * of0 : (1 + far) * of0 - far * of1;
}

/** Return the curves of one stroke, velocities rising. */
export function curvesOf<Curve extends CurveLike>(
  button: { readonly curves: readonly Curve[] },
  stroke: Stroke,
): Curve[] {
  return button.curves
    .filter((curve) => curve.stroke === stroke)
    .sort((a, b) => (a.velocity_mm_s ?? 0) - (b.velocity_mm_s ?? 0));
}

/** Return the curve nearest in velocity, the slowest if none is asked for; null if there is none. */
export function nearest<Curve extends CurveLike>(
  button: { readonly curves: readonly Curve[] },
  stroke: Stroke,
  velocity_mm_s: number | null = null,
): Curve | null {
  const wanted = velocity_mm_s ?? 0;
  let best: Curve | null = null;
  for (const curve of curvesOf(button, stroke)) {
    if (
      !best ||
      Math.abs((curve.velocity_mm_s ?? 0) - wanted) < Math.abs((best.velocity_mm_s ?? 0) - wanted)
    ) {
      best = curve;
    }
  }
  return best;
}

/** Prepare a button's force at fixed displacements. Throws ModelError without a curve of that stroke. */
export function blendOf(button: ButtonLike, stroke: Stroke, x_mm: Numbers, derivative: 0 | 1 = 0): Blend {
  const curves = curvesOf(button, stroke);
  if (!curves.length) throw new ModelError(`model '${button.name}' has no ${stroke} curve`);
  return blend(curves, button.interpolation, x_mm, derivative);
}
