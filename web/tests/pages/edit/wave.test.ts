import { describe, expect, it } from "vitest";
import { decayTo, envelope_m_s2, sound, timeAt_s, times_s } from "../../../src/pages/edit/wave";

const mode = { frequency_Hz: 250, amplitude_m_s2: 8, decay_1_s: 120, phase_rad: 0 };
const vibration = (modes: readonly (typeof mode)[]) =>
  ({ stroke: "press", velocity_mm_s: null, onset_mm: 1, duration_s: 0.016, modes }) as const;

describe("the times of a wave", () => {
  it("end at the duration and hold a turn in twenty steps and more", () => {
    const t = times_s([mode], 0.05);
    expect([t[0], t.at(-1)]).toEqual([0, 0.05]);
    expect(1 / 250 / (t[1] as number)).toBeGreaterThan(20);
  });
});

describe("the handle of a decay", () => {
  it("sits where the envelope has fallen to its level, and gives the decay back from there", () => {
    const at = timeAt_s(mode, 0.5, 1);
    expect(envelope_m_s2(mode, [at])[0]).toBeCloseTo(4, 12);
    expect(decayTo(0.5, at)).toBeCloseTo(120, 9);
  });

  it("stays within the duration where nothing decays", () => {
    expect(timeAt_s({ ...mode, decay_1_s: 0 }, 0.5, 0.02)).toBe(0.02);
  });
});

describe("the sound of a vibration", () => {
  it("has its loudest sample at 0.8 and ends in silence", () => {
    const heard = sound(vibration([mode]), 48000);
    expect(heard.length).toBe(769);
    expect(Math.max(...heard.map(Math.abs))).toBeCloseTo(0.8, 2);
    expect(heard.at(-1)).toBeCloseTo(0, 12);
  });

  it("of nothing is nothing", () => {
    expect(sound(vibration([{ ...mode, amplitude_m_s2: 0 }]), 48000)).toHaveLength(0);
  });
});
