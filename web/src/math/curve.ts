/** Force curves: force and stiffness on displacement, extent, places of the control points. */

import { linspace, roundHalfEven } from "./arrays";
import { evaluate, greville } from "./bspline";
import type { Numbers, Spline } from "./types";

/** Evaluate the force (cN) at displacements (mm); end values outside the knots. */
export function force_cN(curve: Spline, x_mm: Numbers, out?: Float64Array): Float64Array {
  return evaluate(curve.knots_mm, curve.control_points_cN, curve.degree, x_mm, 0, out);
}

/** Evaluate dF/dx (cN/mm) at displacements (mm); 0 outside the knots. */
export function stiffness_cN_mm(curve: Spline, x_mm: Numbers, out?: Float64Array): Float64Array {
  return evaluate(curve.knots_mm, curve.control_points_cN, curve.degree, x_mm, 1, out);
}

/** Evaluate the force at one displacement. */
export function forceAt_cN(curve: Spline, x_mm: number): number {
  return force_cN(curve, [x_mm])[0]!;
}

/** Return the displacement at which the curve begins. */
export function start_mm(curve: Spline): number {
  return curve.knots_mm[0]!;
}

/** Return the displacement at which the curve ends. */
export function end_mm(curve: Spline): number {
  return curve.knots_mm[curve.knots_mm.length - 1]!;
}

/** Return the places (Greville abscissae) at which the control points act, one for each. */
export function controlPoints_mm(curve: Spline): Float64Array {
  return greville(curve.knots_mm, curve.degree);
}

/** Return positions about step_mm apart from start to end of the curve, both included. */
export function places_mm(curve: Spline, step_mm = 0.05): Float64Array {
  const [from, to] = [start_mm(curve), end_mm(curve)];
  return linspace(from, to, Math.max(2, roundHalfEven((to - from) / step_mm) + 1));
}
