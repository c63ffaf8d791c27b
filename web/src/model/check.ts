/** What every model must hold, as `fdvv.model` checks it; the server checks once more. */

import { checkSpline, g, ModelError, type Numbers, STROKES } from "../math";
import type { CurveSpread, FDVVModel, ForceCurve, Mode, Vibration } from "./types";

const LARGEST_mm = 1e3;
const LARGEST_cN = 1e6;

/** Refuse what is no model, in one line. Throws ModelError. */
export function checkModel(model: FDVVModel): void {
  if (!model.name || model.name !== model.name.trim()) {
    refuse(`name must be text without spaces at its ends, got '${model.name}'`);
  }
  positive(model.travel_mm, "travel_mm");
  within([model.travel_mm], LARGEST_mm, "travel_mm");
  for (const point of ["actuation", "reset"] as const) checkPoint(model, point);
  if (!model.curves.length) refuse("a model needs at least one curve, got none");
  model.curves.forEach(checkCurve);
  model.vibrations.forEach(checkVibration);
  for (const stroke of STROKES) {
    for (const [what, parts] of [
      ["curve", model.curves],
      ["vibration", model.vibrations],
    ] as const) {
      checkVelocities(
        stroke,
        what,
        parts.filter((p) => p.stroke === stroke).map((p) => p.velocity_mm_s),
      );
    }
  }
}

function refuse(reason: string): never {
  throw new ModelError(reason);
}

function checkPoint(model: FDVVModel, point: "actuation" | "reset"): void {
  const place = model[`${point}_mm`];
  if (place === null) {
    if (model[`${point}_spread`]) refuse(`${point}_mm is unknown, so it has no spread`);
  } else if (!(place >= 0 && place <= model.travel_mm)) {
    refuse(`${point}_mm must lie within the travel of ${model.travel_mm} mm, got ${place}`);
  }
}

function checkVelocities(stroke: string, what: string, velocities: readonly (number | null)[]): void {
  const got = `[${velocities.map((v) => v ?? "unknown").join(", ")}] mm/s`;
  if (new Set(velocities).size !== velocities.length)
    refuse(`${stroke} has two ${what}s at one velocity: ${got}`);
  if (velocities.includes(null) && velocities.length > 1) {
    refuse(`a ${stroke} ${what} of unknown velocity must stand alone, got ${got}`);
  }
}

/** Refuse what is no force curve. */
export function checkCurve(curve: ForceCurve): void {
  checkVelocity(curve.velocity_mm_s);
  finite(curve.knots_mm, "knots_mm");
  finite(curve.control_points_cN, "control_points_cN");
  within(curve.knots_mm, LARGEST_mm, "knots_mm");
  within(curve.control_points_cN, LARGEST_cN, "control_points_cN");
  checkSpline(curve.knots_mm, curve.control_points_cN, curve.degree);
  if (curve.spread) checkSpread(curve.spread);
}

function checkSpread({ displacement_mm: x, spread_cN: y, presses }: CurveSpread): void {
  if (x.length !== y.length || x.length < 2) {
    refuse(`a spread needs 2 places or more and a value for each, got ${x.length} and ${y.length}`);
  }
  if (x.some((at, i) => i > 0 && at <= x[i - 1]!)) refuse("displacement_mm of a spread must rise strictly");
  if (presses < 2) refuse(`a spread takes at least 2 presses, got ${presses}`);
}

/** Refuse what is no vibration. */
export function checkVibration(vibration: Vibration): void {
  checkVelocity(vibration.velocity_mm_s);
  if (!Number.isFinite(vibration.onset_mm)) refuse(`onset_mm must be finite, got ${vibration.onset_mm}`);
  positive(vibration.duration_s, "duration_s");
  if (!vibration.modes.length) refuse("a vibration needs at least one mode");
  vibration.modes.forEach(checkMode);
  const count = vibration.spread?.modes.length ?? 0;
  if (count && count !== vibration.modes.length) {
    refuse(`the spread tells of ${count} modes, the vibration has ${vibration.modes.length}`);
  }
}

function checkMode({ frequency_Hz, amplitude_m_s2, decay_1_s, phase_rad }: Mode): void {
  const numbers = [frequency_Hz, amplitude_m_s2, decay_1_s, phase_rad];
  if (!numbers.every(Number.isFinite) || frequency_Hz <= 0 || decay_1_s < 0) {
    refuse(
      `a mode needs a positive frequency and a decay of at least 0, got ${frequency_Hz} Hz, ` +
        `${amplitude_m_s2} m/s², ${decay_1_s} 1/s, ${phase_rad} rad`,
    );
  }
}

function checkVelocity(velocity_mm_s: number | null): void {
  if (velocity_mm_s !== null) positive(velocity_mm_s, "velocity_mm_s");
}

function positive(value: number, name: string): void {
  if (!(Number.isFinite(value) && value > 0)) refuse(`${name} must be positive and finite, got ${value}`);
}

function finite(values: Numbers, name: string): void {
  for (let i = 0; i < values.length; i++) {
    if (!Number.isFinite(values[i])) refuse(`${name} must be finite, got ${values[i]} at index ${i}`);
  }
}

function within(values: Numbers, most: number, name: string): void {
  let worst = 0;
  for (let i = 0; i < values.length; i++) worst = Math.max(worst, Math.abs(values[i]!));
  if (worst > most) refuse(`${name} must stay within ${g(most)}, got ${g(worst)}`);
}
