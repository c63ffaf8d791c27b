/** Edits of a button as a whole: its force, its bump and its travel, each by one number. */

import { controlPoints_mm, g } from "../math";
import { type Edit, noted } from "./edit";
import { isAt, label } from "./model";
import type { CurveRef, FDVVModel, ForceCurve } from "./types";

/** Which curves are meant: all of them, or one. */
export type Whose = CurveRef | "all";

/** Multiply the force. */
export function scaleForce(ratio: number, whose: Whose = "all"): Edit {
  return shaped(`force ×${g(ratio)}`, whose, (curve) => curve.control_points_cN.map((c) => ratio * c));
}

/** Multiply the straight line through a curve and keep what departs from it: lighter or heavier, the same bump. */
export function scaleBase(ratio: number, whose: Whose = "all"): Edit {
  return shaped(`force ×${g(ratio)}, same bump`, whose, (curve) => parted(curve, ratio, 1));
}

/** Multiply what departs from the straight line through a curve: more or less click, the same force. */
export function scaleBump(ratio: number, whose: Whose = "all"): Edit {
  return shaped(`bump ×${g(ratio)}, same force`, whose, (curve) => parted(curve, 1, ratio));
}

/** Stretch everything along the travel: curves, actuation, reset and vibrations keep their part of it. */
export function stretchTravel(travel_mm: number): Edit {
  return {
    label: `stretch the travel to ${g(travel_mm)} mm`,
    change: (model) => stretched(model, travel_mm),
  };
}

/**
 * Scale line and departure of each control point; the line is the least-squares one through them, as in
 * `fdvv_people.optimize.model_space`. No force becomes a pull that was none.
 */
function parted(curve: ForceCurve, line_ratio: number, rest_ratio: number): number[] {
  const x = controlPoints_mm(curve);
  const y = curve.control_points_cN;
  const line = lineThrough(x, y);
  return y.map((c, i) => {
    const on = line(x[i]!);
    return Math.max(Math.min(0, c), line_ratio * on + rest_ratio * (c - on));
  });
}

function lineThrough(x: ArrayLike<number>, y: readonly number[]): (x: number) => number {
  const n = y.length;
  const [mx, my] = [y.reduce((sum, _, i) => sum + x[i]!, 0) / n, y.reduce((sum, c) => sum + c, 0) / n];
  let [sxx, sxy] = [0, 0];
  y.forEach((c, i) => {
    sxx += (x[i]! - mx) ** 2;
    sxy += (x[i]! - mx) * (c - my);
  });
  const slope = sxx > 0 ? sxy / sxx : 0;
  return (at) => my + slope * (at - mx);
}

function shaped(what: string, whose: Whose, points: (curve: ForceCurve) => number[]): Edit {
  const meant = (curve: CurveRef) => whose === "all" || isAt(curve, whose);
  const of = whose === "all" ? "all curves" : label(whose);
  const change = (curve: ForceCurve): ForceCurve => {
    // what is drawn was never measured, so it has no spread
    const { spread: _spread, ...kept } = curve;
    return { ...kept, control_points_cN: points(curve).map((c) => c + 0) };
  };
  return {
    label: `${of}: ${what}`,
    change: (model) => {
      const curves = model.curves.map((curve) => (meant(curve) ? change(curve) : curve));
      return noted({ ...model, curves }, `${of} drawn`);
    },
  };
}

function stretched(model: FDVVModel, travel_mm: number): FDVVModel {
  const by = travel_mm / model.travel_mm;
  const at = (place: number | null) => (place === null ? null : Math.min(place * by, travel_mm));
  const { travel_spread: _t, actuation_spread: _a, reset_spread: _r, ...kept } = model;
  return noted(
    {
      ...kept,
      travel_mm,
      curves: model.curves.map(({ spread: _spread, ...curve }) => ({
        ...curve,
        knots_mm: curve.knots_mm.map((x) => x * by),
      })),
      actuation_mm: at(model.actuation_mm),
      reset_mm: at(model.reset_mm),
      vibrations: model.vibrations.map(({ spread: _spread, ...one }) => ({
        ...one,
        onset_mm: one.onset_mm * by,
      })),
    },
    "travel stretched",
  );
}
