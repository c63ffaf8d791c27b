/** Vibrations as samples; mirrors `fdvv.model.Vibration` and `fdvv.vibration.vibration_samples`. */

import { roundHalfEven } from "./arrays";
import type { Numbers, Stroke, VibrationLike } from "./types";

/** What every sound card plays. */
export const LISTEN_Hz = 48_000;
/** Silence before and after, so that no player cuts the onset off. */
export const QUIET_s = 0.02;

/** Evaluate the cap's acceleration at times after the onset; 0 before it and after the duration. */
export function acceleration_m_s2(vibration: VibrationLike, t_s: Numbers): Float64Array {
  const out = new Float64Array(t_s.length);
  for (let i = 0; i < out.length; i++) {
    const t = t_s[i]!;
    if (!(t >= 0 && t <= vibration.duration_s)) continue;
    for (const mode of vibration.modes) {
      const envelope = mode.amplitude_m_s2 * Math.exp(-mode.decay_1_s * t);
      out[i] = out[i]! + envelope * Math.sin(2 * Math.PI * mode.frequency_Hz * t + mode.phase_rad);
    }
  }
  return out;
}

/** Return a vibration's acceleration (m/s²) at a rate, with silence before and after. */
export function vibrationSamples(
  vibration: VibrationLike,
  rate_Hz = LISTEN_Hz,
  quiet_s = QUIET_s,
): Float64Array {
  const t = new Float64Array(roundHalfEven((vibration.duration_s + 2 * quiet_s) * rate_Hz));
  for (let i = 0; i < t.length; i++) t[i] = i / rate_Hz - quiet_s;
  return acceleration_m_s2(vibration, t);
}

/** Return the largest |acceleration| of the samples at a rate, m/s². */
export function peak_m_s2(vibration: VibrationLike, rate_Hz = LISTEN_Hz): number {
  return vibrationSamples(vibration, rate_Hz, 0).reduce((most, a) => Math.max(most, Math.abs(a)), 0);
}

/** Return how long a vibration lasts until all its modes have fallen to a share of their amplitude, s. */
export function decayTime_s(vibration: VibrationLike, share = 0.01): number {
  const slowest = Math.min(...vibration.modes.map((mode) => mode.decay_1_s));
  return slowest > 0 ? Math.min(vibration.duration_s, Math.log(1 / share) / slowest) : vibration.duration_s;
}

/** Return the vibration of the stroke nearest in velocity; null if it has none. */
export function nearestVibration<Of extends VibrationLike>(
  vibrations: readonly Of[],
  stroke: Stroke,
  velocity_mm_s: number,
): Of | null {
  let best: Of | null = null;
  const off = (v: Of) => Math.abs((v.velocity_mm_s ?? 0) - velocity_mm_s);
  for (const one of vibrations) if (one.stroke === stroke && (!best || off(one) < off(best))) best = one;
  return best;
}
