/** A stand-in for a key: a drawn hand on a modelled sensor. Simulated, not recorded from a person or a keyboard. */

import type { Recording } from "./recording";

const FULL_mm = 4;
const RATE_Hz = 1000;
const STEPS = 255;
/** Noise of the sensor, and how a report's time scatters; one standard deviation each. */
const NOISE_mm = 0.006;
const JITTER_ms = 0.06;
const TREMOR = { mm: 0.02, Hz: 9 } as const;
/** From place to place on minimum jerk: s to get there, s to stay, mm. The first ones are slow, the last repeat. */
const STROKES: readonly (readonly [move_s: number, hold_s: number, to_mm: number])[] = [
  [0, 0.25, 0],
  [0.3, 0.15, 4],
  [0.3, 0.35, 0],
  [0.06, 0.06, 4],
  [0.08, 0.3, 0],
  [0.09, 0.02, 2.6],
  [0.05, 0.02, 1.9],
  [0.05, 0.02, 2.7],
  [0.05, 0.02, 1.9],
  [0.05, 0.04, 2.8],
  [0.09, 0.3, 0],
];

/** Make some 2.6 s of a key, the same for the same seed. */
export function simulatedRecording(seed = 1): Recording {
  const random = gaussian(seed);
  const [t_ms, depth_mm]: [number[], number[]] = [[], []];
  const path = pathOf();
  for (let i = 0; i < path.length; i++) {
    const mm = path[i] as number;
    const touched = Math.min(1, mm / 0.2) * Math.min(1, (FULL_mm - mm) / 0.1 + 0.1);
    const tremor_mm = TREMOR.mm * Math.max(0, touched) * Math.sin((2 * Math.PI * TREMOR.Hz * i) / RATE_Hz);
    const read = Math.round(((mm + tremor_mm + NOISE_mm * random()) / FULL_mm) * STEPS);
    depth_mm.push((Math.min(STEPS, Math.max(0, mm > 0.02 ? read : 0)) / STEPS) * FULL_mm);
    t_ms.push(Math.max(t_ms.at(-1) ?? 0, (1000 * i) / RATE_Hz + JITTER_ms * random()));
  }
  return {
    device: "no keyboard",
    key: "no key",
    rate_Hz: RATE_Hz,
    full_scale_mm: FULL_mm,
    simulated: "a drawn hand on a modelled sensor of 8 bits",
    t_ms,
    depth_mm,
  };
}

function pathOf(): number[] {
  const path: number[] = [];
  let from_mm = 0;
  for (const [move_s, hold_s, to_mm] of STROKES) {
    const [moves, holds] = [Math.round(move_s * RATE_Hz), Math.round(hold_s * RATE_Hz)];
    for (let i = 1; i <= moves; i++) path.push(from_mm + (to_mm - from_mm) * smooth(i / moves));
    for (let i = 0; i < holds; i++) path.push(to_mm);
    from_mm = to_mm;
  }
  return path;
}

/** Minimum jerk from 0 to 1. */
function smooth(s: number): number {
  return s ** 3 * (10 + s * (6 * s - 15));
}

/** Normal numbers from a seed (mulberry32, sum of twelve). */
function gaussian(seed: number): () => number {
  let state = seed >>> 0;
  const uniform = () => {
    state = (state + 0x6d2b79f5) >>> 0;
    let z = Math.imul(state ^ (state >>> 15), state | 1);
    z ^= z + Math.imul(z ^ (z >>> 7), z | 61);
    return ((z ^ (z >>> 14)) >>> 0) / 2 ** 32;
  };
  return () => Array.from({ length: 12 }, uniform).reduce((sum, one) => sum + one, -6);
}
