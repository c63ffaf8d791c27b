/** A model as it stands in a `*.fdvv.json` file (docs/reference/model-file.md); its values never change in place. */

import type { ButtonLike, CurveLike, ModeLike, Stroke, VibrationLike } from "../math";

/** How the force of a curve differs between presses. */
export interface CurveSpread {
  readonly presses: number;
  readonly displacement_mm: readonly number[];
  readonly spread_cN: readonly number[];
  readonly achieved_mm_s: number | null;
  readonly achieved_spread_mm_s: number | null;
}

/** How a point of the travel differs between presses. */
export interface PointSpread {
  readonly spread_mm: number;
  readonly presses: number;
}

/** Standard deviations between presses of one mode; null if unknown. */
export interface ModeSpread {
  readonly frequency_Hz: number | null;
  readonly amplitude_m_s2: number | null;
  readonly decay_1_s: number | null;
}

/** How a vibration differs between presses. */
export interface VibrationSpread {
  readonly presses: number;
  readonly onset_mm: number | null;
  readonly duration_s: number | null;
  readonly modes: readonly ModeSpread[];
}

/** A force curve of the file; no spread where none was measured. */
export interface ForceCurve extends CurveLike {
  readonly knots_mm: readonly number[];
  readonly control_points_cN: readonly number[];
  readonly spread?: CurveSpread;
}

export type Mode = ModeLike;

/** A vibration of the file; no spread where none was measured. */
export interface Vibration extends VibrationLike {
  readonly modes: readonly Mode[];
  readonly spread?: VibrationSpread;
}

/** Where a model comes from. */
export interface Provenance {
  readonly source: string;
  readonly licence: string;
  readonly citation: string;
  readonly method: string;
  readonly assumptions: readonly string[];
  readonly simulated: boolean;
}

/** A whole model. */
export interface FDVVModel extends ButtonLike {
  readonly format: "fdvv-model";
  /** 2 if the model tells of spreads. */
  readonly version: 1 | 2;
  readonly curves: readonly ForceCurve[];
  readonly vibrations: readonly Vibration[];
  readonly provenance: Provenance;
  readonly travel_spread?: PointSpread;
  readonly actuation_spread?: PointSpread;
  readonly reset_spread?: PointSpread;
}

/** Names a curve, or a vibration, of a model. */
export interface CurveRef {
  readonly stroke: Stroke;
  readonly velocity_mm_s: number | null;
}

/** Names control points of one curve. */
export interface PointsRef extends CurveRef {
  readonly indices: readonly number[];
}
