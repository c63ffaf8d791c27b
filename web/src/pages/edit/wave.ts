/** A vibration as numbers over time: envelope and sound. */

import { acceleration_m_s2, type ModeLike, type VibrationLike } from "../../math";

/** Amplitude of the loudest sample of a sound, below clipping. */
const LOUD = 0.8;
/** The last part of a sound fades, so that it ends without a click. */
const FADE_s = 0.002;

type Modes = readonly ModeLike[];

/** Envelope of one mode, m/s²: never negative. */
export function envelope_m_s2(mode: ModeLike, t_s: ArrayLike<number>): Float64Array {
  const out = new Float64Array(t_s.length);
  for (let i = 0; i < out.length; i++)
    out[i] = Math.abs(mode.amplitude_m_s2) * Math.exp(-mode.decay_1_s * (t_s[i] as number));
  return out;
}

/** Times from 0 to the end, fine enough for the fastest mode. */
export function times_s(modes: Modes, duration_s: number): Float64Array {
  const fastest = Math.max(100, ...modes.map((m) => m.frequency_Hz));
  const count = Math.min(4000, Math.max(200, Math.ceil(duration_s * fastest * 24)));
  return Float64Array.from({ length: count + 1 }, (_, i) => (duration_s * i) / count);
}

/** The decay that brings a mode to `level` of its amplitude after a time. */
export function decayTo(level: number, t_s: number): number {
  return Math.max(0, -Math.log(Math.min(1, Math.max(1e-6, level))) / Math.max(1e-5, t_s));
}

/** The time after which a mode is at a level of its amplitude, the duration if it never is within it. */
export function timeAt_s(mode: ModeLike, level: number, duration_s: number): number {
  const t = mode.decay_1_s > 0 ? -Math.log(level) / mode.decay_1_s : duration_s;
  return Math.min(duration_s, t);
}

/** Samples of the vibration as sound, the loudest at 0.8, the end faded; empty if it is silent. */
export function sound(vibration: VibrationLike, rate_Hz: number): Float32Array<ArrayBuffer> {
  const { duration_s } = vibration;
  const count = Math.ceil(duration_s * rate_Hz) + 1;
  const wave = acceleration_m_s2(
    vibration,
    Float64Array.from({ length: count }, (_, i) => i / rate_Hz),
  );
  const loudest = wave.reduce((most, a) => Math.max(most, Math.abs(a)), 0);
  if (loudest === 0) return new Float32Array(0);
  const fade = Math.min(FADE_s, 0.5 * duration_s) * rate_Hz;
  return Float32Array.from(wave, (a, i) => ((LOUD * a) / loudest) * Math.min(1, (count - 1 - i) / fade));
}
