/** What the mathematics needs to know of a button; names and units are those of the `*.fdvv.json` file. */

/** Numbers in a row, whatever holds them. */
export type Numbers = ArrayLike<number>;

/** The two halves of a button's cycle. */
export type Stroke = "press" | "release";

export const STROKES: readonly Stroke[] = ["press", "release"];

/** How force is found between the velocities. */
export type Interpolation = "nearest" | "linear" | "pchip";

export const INTERPOLATIONS: readonly Interpolation[] = ["nearest", "linear", "pchip"];

/** A clamped B-spline: n + degree + 1 knots and n control points. */
export interface Spline {
  readonly degree: number;
  readonly knots_mm: Numbers;
  readonly control_points_cN: Numbers;
}

/** Force on displacement for one stroke at one velocity; null where the velocity is unknown. */
export interface CurveLike extends Spline {
  readonly stroke: Stroke;
  readonly velocity_mm_s: number | null;
}

/** One decaying sinusoid, A exp(-d t) sin(2 pi f t + phase). */
export interface ModeLike {
  readonly frequency_Hz: number;
  readonly amplitude_m_s2: number;
  readonly decay_1_s: number;
  readonly phase_rad: number;
}

/** The damped modes that start at one displacement of one stroke; null serves every velocity. */
export interface VibrationLike {
  readonly stroke: Stroke;
  readonly velocity_mm_s: number | null;
  readonly onset_mm: number;
  readonly duration_s: number;
  readonly modes: readonly ModeLike[];
}

/** The part of a model that its force and its landmarks follow from. */
export interface ButtonLike {
  readonly name: string;
  readonly travel_mm: number;
  readonly actuation_mm: number | null;
  readonly reset_mm: number | null;
  readonly interpolation: Interpolation;
  readonly curves: readonly CurveLike[];
}

/** Numbers that do not make a curve or a model; the text is one line for a person. */
export class ModelError extends Error {
  override readonly name = "ModelError";
}
