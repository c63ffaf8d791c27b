/** The mathematics of buttons: an exact mirror of `fdvv.model`, and what editing a curve takes. */

export { linspace, trapezoid } from "./arrays";
export { basis, checkSpline, evaluate, findSpan, greville, uniformKnots } from "./bspline";
export { type Bump, drop_cN, findBump, LEAST_DROP_cN, runningMean, snapRatio } from "./bump";
export { buttonDifference, type Difference, differences } from "./compare";
export { type Constraints, constrain, keepWork, limit, monotone, snap, type Work } from "./constraints";
export {
  controlPoints_mm,
  end_mm,
  force_cN,
  forceAt_cN,
  places_mm,
  start_mm,
  stiffness_cN_mm,
} from "./curve";
export { integral_cN_mm, integralWeights } from "./integral";
export { type Added, addPoint, insertKnot, type Refitted, refit, removePoint } from "./knots";
export { bumpOf, dense, type Landmarks, landmarks, mJ_PER_cN_mm, work_mJ } from "./landmarks";
export { type Spliced, splice } from "./splice";
export { type Surface, surface, surfaceGrid } from "./surface";
export {
  type ButtonLike,
  type CurveLike,
  INTERPOLATIONS,
  type Interpolation,
  type ModeLike,
  ModelError,
  type Numbers,
  type Spline,
  STROKES,
  type Stroke,
  type VibrationLike,
} from "./types";
export { type Blend, blend, blendOf, curvesOf, nearest } from "./velocity";
export {
  acceleration_m_s2,
  decayTime_s,
  LISTEN_Hz,
  nearestVibration,
  peak_m_s2,
  vibrationSamples,
} from "./vibration";
export { g, speed } from "./words";
