/** Edits of control points and of the knots they stand on. */

import {
  addPoint as added,
  type Constraints,
  constrain,
  g,
  integralWeights,
  refit,
  removePoint as removed,
  type Spline,
  start_mm,
} from "../math";
import { type Edit, noted } from "./edit";
import { foundCurve, label, withCurve } from "./model";
import type { CurveRef, FDVVModel, ForceCurve, PointsRef } from "./types";

/** Control points of one curve, each with the force it is to have: index and cN. */
export interface PointValues extends CurveRef {
  readonly values_cN: readonly (readonly [number, number])[];
}

/** Move control points, of one curve or several, by one force; what they drag along follows the constraints. */
export function movePoints(
  points: readonly PointsRef[],
  delta_cN: number,
  constraints: Constraints = {},
): Edit {
  const count = points.reduce((sum, { indices }) => sum + indices.length, 0);
  return {
    label: `move ${counted(count)}${ofCurves(points)}`,
    change: (model) =>
      points.reduce((now, at) => {
        const there = foundCurve(model, at).control_points_cN;
        const values_cN = at.indices.map((i) => [i, there[i]! + delta_cN] as const);
        return placed(now, { ...at, values_cN }, constraints);
      }, model),
  };
}

/** Set control points to exact forces. */
export function setPoints(points: readonly PointValues[], constraints: Constraints = {}): Edit {
  const all = points.flatMap(({ values_cN }) => values_cN);
  const value = all.length === 1 ? ` to ${g(all[0]![1])} cN` : "";
  return {
    label: `set ${counted(all.length)}${value}${ofCurves(points)}`,
    change: (model) => points.reduce((now, at) => placed(now, at, constraints), model),
  };
}

function placed(model: FDVVModel, at: PointValues, constraints: Constraints): FDVVModel {
  const curve = foundCurve(model, at);
  const wanted = Array.from(curve.control_points_cN);
  const held = new Set<number>();
  for (const [i, force] of at.values_cN) {
    if (!(i in wanted)) continue;
    wanted[i] = force;
    held.add(i);
  }
  const weights = constraints.keepWork ? integralWeights(curve, start_mm(curve), model.travel_mm) : [];
  const work = { weights, wanted: total(weights, curve.control_points_cN) };
  const control_points_cN = constrain(curve.control_points_cN, wanted, held, constraints, work);
  return drawn(model, curve, { ...curve, control_points_cN });
}

function total(weights: ArrayLike<number>, c: readonly number[]): number {
  return c.reduce((sum, value, i) => sum + (weights[i] ?? 0) * value, 0);
}

/** Add a control point at a place; the shape stays. */
export function addPoint(at: CurveRef, x_mm: number): Edit {
  return shaped(`add a point at ${g(x_mm)} mm to ${label(at)}`, at, (curve) => added(curve, x_mm));
}

/** Remove a control point with the least change of shape. */
export function removePoint(at: CurveRef, index: number): Edit {
  return shaped(`remove a point of ${label(at)}`, at, (curve) => removed(curve, index));
}

/** Put a curve on other knots, as near to its shape as they allow. */
export function refitCurve(at: CurveRef, knots_mm: readonly number[], degree: number): Edit {
  return shaped(`refit ${label(at)}`, at, (curve) => refit(curve, knots_mm, degree));
}

/** Return a curve another shape altogether. */
export function drawCurve(at: CurveRef, shape: Spline, what = `draw ${label(at)}`): Edit {
  return shaped(what, at, () => shape);
}

function shaped(what: string, at: CurveRef, make: (curve: ForceCurve) => Spline): Edit {
  return {
    label: what,
    change: (model) => {
      const curve = foundCurve(model, at);
      return drawn(model, curve, make(curve));
    },
  };
}

/** Put a drawn shape in the place of a curve: it was never measured, so it has no spread, and a note says so. */
function drawn(
  model: FDVVModel,
  curve: ForceCurve,
  { degree, knots_mm, control_points_cN }: Spline,
): FDVVModel {
  const { stroke, velocity_mm_s } = curve;
  const numbers = { knots_mm: plain(knots_mm), control_points_cN: plain(control_points_cN) };
  return noted(withCurve(model, { stroke, velocity_mm_s, degree, ...numbers }), `${label(curve)} drawn`);
}

/** Plain numbers without a negative zero, which JSON would not carry. */
function plain(values: ArrayLike<number>): number[] {
  return Array.from(values, (value) => value + 0);
}

function counted(count: number): string {
  return count === 1 ? "a point" : `${count} points`;
}

function ofCurves(points: readonly CurveRef[]): string {
  return points.length === 1 ? ` of ${label(points[0]!)}` : ` of ${points.length} curves`;
}
