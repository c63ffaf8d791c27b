/** Curves as points for the screen: evaluated once as long as a curve stays the same, which most do during a drag. */

import type { Scale } from "../../draw";
import { end_mm, force_cN, linspace, type Spline, start_mm } from "../../math";

const POINTS = 400;

/** A curve as columns. */
export interface Sampled {
  readonly x_mm: Float64Array;
  readonly force_cN: Float64Array;
}

const kept = new WeakMap<object, Sampled>();

/** A curve at 400 places; models never change in place, so the same curve is the same object. */
export function sampled(curve: Spline): Sampled {
  const found = kept.get(curve);
  if (found) return found;
  const x_mm = linspace(start_mm(curve), end_mm(curve), POINTS);
  const made = { x_mm, force_cN: force_cN(curve, x_mm) };
  kept.set(curve, made);
  return made;
}

/** A column in pixels. */
export function inPixels(scale: Scale, column: ArrayLike<number>): Float64Array {
  const out = new Float64Array(column.length);
  for (let i = 0; i < out.length; i++) out[i] = scale.px(column[i] as number);
  return out;
}

/** The force of a sampled curve at a place, straight between the samples; the end values beyond them. */
export function forceNear_cN({ x_mm, force_cN: force }: Sampled, x: number): number {
  const last = x_mm.length - 1;
  const at = ((x - x_mm[0]!) / (x_mm[last]! - x_mm[0]!)) * last;
  if (!(at > 0)) return force[0]!;
  if (at >= last) return force[last]!;
  const i = Math.floor(at);
  return force[i]! + (at - i) * (force[i + 1]! - force[i]!);
}

/** How far a place is from a sampled curve on the screen, px; only the part near the place is looked at. */
export function away_px(
  of: Sampled,
  x: Scale,
  y: Scale,
  at: { readonly x_px: number; readonly y_px: number },
): number {
  const reach = 24;
  const { x_mm, force_cN: force } = of;
  let least = Infinity;
  for (let i = 0; i < x_mm.length; i++) {
    const dx = x.px(x_mm[i]!) - at.x_px;
    if (Math.abs(dx) > reach) continue;
    least = Math.min(least, Math.hypot(dx, y.px(force[i]!) - at.y_px));
  }
  return least;
}
