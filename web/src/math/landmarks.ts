/** The points and figures that people compare buttons by; mirrors `fdvv.model._landmarks`, same names. */

import { firstNotBelow, linspace, roundHalfEven, trapezoid } from "./arrays";
import { type Bump, findBump, snapRatio } from "./bump";
import { force_cN, forceAt_cN, start_mm, stiffness_cN_mm } from "./curve";
import { type ButtonLike, ModelError, type Numbers, type Spline } from "./types";
import { nearest } from "./velocity";

/** Landmarks are read off the spline at this step. */
export const STEP_mm = 0.005;
/** The contact step ends within this length of the contact. */
const CONTACT_REACH_mm = 0.4;
/** A contact step is steeper than this. */
const STOP_LEAST_cN_mm = 100;
/** 1 cN mm = 0.01 mJ. */
export const mJ_PER_cN_mm = 0.01;

/**
 * Landmarks of a button at one velocity; null where the button has no such point or it is unknown. Their
 * meaning is documented in `fdvv.model.Landmarks`.
 */
export interface Landmarks {
  readonly velocity_mm_s: number | null;
  readonly contact_mm: number;
  readonly preload_cN: number;
  readonly peak_mm: number | null;
  readonly peak_cN: number | null;
  readonly valley_mm: number | null;
  readonly valley_cN: number | null;
  readonly snap_ratio: number | null;
  readonly release_peak_cN: number | null;
  readonly release_valley_cN: number | null;
  readonly actuation_mm: number | null;
  readonly actuation_cN: number | null;
  readonly reset_mm: number | null;
  readonly bottom_out_mm: number;
  readonly bottom_out_cN: number;
  readonly travel_mm: number;
  readonly pre_travel_mm: number | null;
  readonly post_travel_mm: number | null;
  readonly pre_slope_cN_mm: number;
  readonly post_slope_cN_mm: number;
  readonly steepest_fall_cN_mm: number;
  readonly work_mJ: number;
  readonly release_work_mJ: number | null;
  readonly hysteresis_loss_mJ: number | null;
}

/** Return the places that landmarks are read from: the curve to the end of the travel, longer if it must. */
export function dense(curve: Spline, end_mm: number): Float64Array {
  const start = start_mm(curve);
  const end = Math.max(end_mm, start + STEP_mm);
  return linspace(start, end, Math.max(8, roundHalfEven((end - start) / STEP_mm) + 1));
}

/** Return the work of a stroke over the travel, mJ: the area under the curve. */
export function work_mJ(curve: Spline, travel_mm: number): number {
  const x = dense(curve, travel_mm);
  return trapezoid(x, force_cN(curve, x)) * mJ_PER_cN_mm;
}

/** Return the bump of one curve over the travel; null if it has none. */
export function bumpOf(curve: Spline, travel_mm: number): Bump | null {
  const x = dense(curve, travel_mm);
  return findBump(x, force_cN(curve, x));
}

/**
 * Read the landmarks of a button from its press curve nearest to a velocity (the slowest by default).
 *
 * The release, where there is one, is the curve nearest to the same velocity. Throws ModelError if the button
 * has no press curve.
 */
export function landmarks(button: ButtonLike, velocity_mm_s: number | null = null): Landmarks {
  const press = nearest(button, "press", velocity_mm_s);
  if (!press) throw new ModelError(`model '${button.name}' has no press curve to read landmarks from`);
  const release = nearest(button, "release", velocity_mm_s);
  const { travel_mm: travel, actuation_mm: close } = button;
  const x = dense(press, travel);
  const force = force_cN(press, x);
  const slope = stiffness_cN_mm(press, x);
  const bump = findBump(x, force);
  const stepEnd = contactStepEnd(x, slope);
  const work = trapezoid(x, force) * mJ_PER_cN_mm;
  const contact = start_mm(press);
  return {
    velocity_mm_s: press.velocity_mm_s,
    contact_mm: contact,
    preload_cN: force[stepEnd]!,
    ...ofBump(bump),
    ...ofRelease(release, travel, work),
    actuation_mm: close,
    actuation_cN: close === null ? null : forceAt_cN(press, close),
    reset_mm: button.reset_mm,
    bottom_out_mm: travel,
    bottom_out_cN: force[force.length - 1]!,
    travel_mm: travel - contact,
    pre_travel_mm: close === null ? null : close - contact,
    post_travel_mm: close === null ? null : travel - close,
    pre_slope_cN_mm: preSlope(x, force, bump, stepEnd),
    post_slope_cN_mm: postSlope(x, force),
    steepest_fall_cN_mm: slope.subarray(stepEnd).reduce((least, s) => Math.min(least, s), 0),
    work_mJ: work,
  };
}

function ofBump(bump: Bump | null) {
  if (bump) return { ...bump, snap_ratio: snapRatio(bump) };
  return { peak_mm: null, peak_cN: null, valley_mm: null, valley_cN: null, snap_ratio: null };
}

function ofRelease(release: Spline | null, travel_mm: number, press_mJ: number) {
  if (!release) {
    return {
      release_peak_cN: null,
      release_valley_cN: null,
      release_work_mJ: null,
      hysteresis_loss_mJ: null,
    };
  }
  const x = dense(release, travel_mm);
  const force = force_cN(release, x);
  const bump = findBump(x, force);
  const work = trapezoid(x, force) * mJ_PER_cN_mm;
  return {
    release_peak_cN: bump?.peak_cN ?? null,
    release_valley_cN: bump?.valley_cN ?? null,
    release_work_mJ: work,
    hysteresis_loss_mJ: press_mJ - work,
  };
}

/** Find the index where the contact step has been climbed; 0 if the curve has none. */
function contactStepEnd(x: Numbers, slope: Float64Array): number {
  const near = Math.max(2, firstNotBelow(x, x[0]! + CONTACT_REACH_mm));
  for (let i = Math.min(near, slope.length) - 1; i >= 0; i--) {
    if (slope[i]! > STOP_LEAST_cN_mm) return Math.min(i + 1, x.length - 2);
  }
  return 0;
}

function preSlope(x: Numbers, force: Numbers, bump: Bump | null, stepEnd: number): number {
  const end = Math.max(bump ? firstNotBelow(x, bump.peak_mm) : x.length - 1, stepEnd + 1);
  return (force[end]! - force[stepEnd]!) / (x[end]! - x[stepEnd]!);
}

/** Fit a line over the last quarter of the travel. */
function postSlope(x: Float64Array, force: Float64Array): number {
  const end = x[x.length - 1]!;
  const first = x.findIndex((at) => at >= end - 0.25 * (end - x[0]!));
  const count = x.length - first;
  let [sumX, sumF] = [0, 0];
  for (let i = first; i < x.length; i++) [sumX, sumF] = [sumX + x[i]!, sumF + force[i]!];
  let [top, bottom] = [0, 0];
  for (let i = first; i < x.length; i++) {
    const off = x[i]! - sumX / count;
    top += off * (force[i]! - sumF / count);
    bottom += off * off;
  }
  return top / bottom;
}
