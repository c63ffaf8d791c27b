/**
 * Put a piece of one B-spline into another, exactly: cut, bridge, join; mirrors `fdvv.model._splice`.
 *
 * Notation: t knots, c coefficients, k degree.
 */

import { firstAbove, firstNotBelow, linspace } from "./arrays";
import { basis, evaluate, findSpan, greville, multiplicity } from "./bspline";
import { end_mm, start_mm } from "./curve";
import { insertKnot, NEAR_mm } from "./knots";
import { solve } from "./linear";
import { ModelError, type Numbers, type Spline } from "./types";
import { g } from "./words";

/** A bridge meets a value and a slope at both ends, which takes a cubic. */
const BRIDGE_DEGREE = 3;

interface Piece {
  readonly t: Float64Array;
  readonly c: Float64Array;
}

/** Place, value and slope. */
type Joint = readonly [number, number, number];

/** A spline of its own numbers. */
export interface Spliced extends Spline {
  readonly knots_mm: Float64Array;
  readonly control_points_cN: Float64Array;
}

/**
 * Make base follow insert on a segment.
 *
 * Inside the segment the result is insert, beyond it by more than blend_mm it is base, both to rounding;
 * between lies one cubic that continues value and slope on both sides. At an end of base there is no bridge,
 * near one it is shorter. The degree is the larger of the two and at least 3.
 *
 * Throws ModelError if the segment is empty or leaves either curve, if blend_mm is not positive, or if a curve
 * that jumps would have to be raised in degree.
 */
export function splice(
  base: Spline,
  insert: Spline,
  segment_mm: readonly [number, number],
  blend_mm = 0.1,
): Spliced {
  check(base, insert, segment_mm, blend_mm);
  const k = Math.max(base.degree, insert.degree, BRIDGE_DEGREE);
  const [outer, inner] = [elevated(base, k), elevated(insert, k)];
  const [a, b] = segment_mm.map((x) => ontoKnot(outer.t, ontoKnot(inner.t, x))) as [number, number];
  const middle = cut(inner, k, a, b);
  const pieces = [middle];
  if (a > start_mm(base)) {
    const left = cut(outer, k, start_mm(base), ontoKnot(outer.t, Math.max(start_mm(base), a - blend_mm)));
    const before = left.c.length ? endOf(left, k) : startOf(outer, k);
    pieces.unshift(...(left.c.length ? [left] : []), bridge(before, startOf(middle, k), k));
  }
  if (b < end_mm(base)) {
    const right = cut(outer, k, ontoKnot(outer.t, Math.min(end_mm(base), b + blend_mm)), end_mm(base));
    const after = right.c.length ? startOf(right, k) : endOf(outer, k);
    pieces.push(bridge(endOf(middle, k), after, k), ...(right.c.length ? [right] : []));
  }
  return joined(pieces, k);
}

function check(base: Spline, insert: Spline, [a, b]: readonly [number, number], blend_mm: number): void {
  if (!(Number.isFinite(a) && Number.isFinite(b) && b - a > NEAR_mm)) {
    throw new ModelError(`segment_mm must rise, got ${g(a)} to ${g(b)} mm`);
  }
  if (!(Number.isFinite(blend_mm) && blend_mm > NEAR_mm)) {
    throw new ModelError(`blend_mm must be positive, got ${blend_mm}`);
  }
  for (const [which, curve] of [
    ["edited", base],
    ["assigned", insert],
  ] as const) {
    if (a < start_mm(curve) - NEAR_mm || b > end_mm(curve) + NEAR_mm) {
      const reach = `${g(start_mm(curve))} to ${g(end_mm(curve))} mm`;
      throw new ModelError(
        `segment ${g(a)} to ${g(b)} mm leaves the ${which} curve, which reaches from ${reach}`,
      );
    }
  }
}

function startOf({ t, c }: Piece, k: number): Joint {
  return [t[0]!, c[0]!, (k * (c[1]! - c[0]!)) / (t[k + 1]! - t[0]!)];
}

function endOf({ t, c }: Piece, k: number): Joint {
  const [m, n] = [t.length - 1, c.length - 1];
  return [t[m]!, c[n]!, (k * (c[n]! - c[n - 1]!)) / (t[m]! - t[m - k - 1]!)];
}

function ontoKnot(t: Numbers, x: number): number {
  let nearest = t[0]!;
  for (let i = 1; i < t.length; i++) if (Math.abs(t[i]! - x) < Math.abs(nearest - x)) nearest = t[i]!;
  return Math.abs(nearest - x) <= NEAR_mm ? nearest : x;
}

/** Write a curve in a higher degree: every knot gains a repeat, and the larger space holds the curve. */
function elevated(curve: Spline, to: number): Piece {
  let t: Float64Array = Float64Array.from(curve.knots_mm);
  let c: Float64Array = Float64Array.from(curve.control_points_cN);
  for (let k = curve.degree; k < to; k++) {
    const knots = [...new Set(t)];
    const repeats = knots.map((x) => multiplicity(t, x));
    if (repeats.slice(1, -1).some((count) => count > k)) {
      throw new ModelError(`a curve of degree ${k} with a jump cannot be raised to degree ${to}`);
    }
    const raised = Float64Array.from(knots.flatMap((x, i) => Array<number>(repeats[i]! + 1).fill(x)));
    const sites = greville(raised, k + 1);
    c = solve(designMatrix(raised, k + 1, sites), evaluate(t, c, k, sites));
    t = raised;
  }
  return { t, c };
}

function designMatrix(t: Numbers, k: number, x: Numbers): Float64Array[] {
  return Array.from(x, (at) => {
    const row = new Float64Array(t.length - k - 1);
    const i = findSpan(t, k, at);
    row.set(basis(t, k, i, at), i - k);
    return row;
  });
}

/** Restrict a spline to [a, b] by knot insertion; empty if a = b. */
function cut(piece: Piece, k: number, a: number, b: number): Piece {
  if (b <= a) return { t: new Float64Array(), c: new Float64Array() };
  let { t, c } = piece;
  for (const x of [a, b]) {
    for (let missing = k - multiplicity(t, x); missing > 0; missing--) {
      const made = insertKnot({ degree: k, knots_mm: t, control_points_cN: c }, x);
      [t, c] = [made.knots_mm, made.control_points_cN];
    }
  }
  const [first, last] = [firstAbove(t, a), firstNotBelow(t, b)];
  const ends = (x: number) => Array<number>(k + 1).fill(x);
  return {
    t: Float64Array.from([...ends(a), ...t.subarray(first, last), ...ends(b)]),
    c: c.slice(first - 1 - k, last),
  };
}

/** Make one Bézier piece of degree k with the given place, value and slope at either end. */
function bridge([a, y0, m0]: Joint, [b, y1, m1]: Joint, k: number): Piece {
  const second = y0 + ((b - a) * m0) / k;
  const lastButOne = y1 - ((b - a) * m1) / k;
  const t = new Float64Array(2 * k + 2).fill(a, 0, k + 1).fill(b, k + 1);
  return { t, c: Float64Array.from([y0, ...linspace(second, lastButOne, k - 1), y1]) };
}

/** Join pieces that share value and slope: the control point at a joint is then no freedom of its own. */
function joined(pieces: readonly Piece[], k: number): Spliced {
  let t = Array.from(pieces[0]!.t);
  let c = Array.from(pieces[0]!.c);
  for (const piece of pieces.slice(1)) {
    t = [...t.slice(0, -2), ...piece.t.subarray(k + 1)];
    c = [...c.slice(0, -1), ...piece.c.subarray(1)];
  }
  return { degree: k, knots_mm: Float64Array.from(t), control_points_cN: Float64Array.from(c) };
}
