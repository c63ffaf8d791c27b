import { describe, expect, it } from "vitest";
import { decayTo, envelope_m_s2, sound, timeAt_s, times_s, wave_m_s2 } from "../../../src/pages/edit/wave";

const mode = { frequency_Hz: 250, amplitude_m_s2: 8, decay_1_s: 120, phase_rad: 0 };

describe("the wave of a vibration", () => {
  it("is A exp(-d t) sin(2 pi f t + phase), zero outside its duration", () => {
    const t = [-0.001, 0, 0.001, 0.013, 0.0161];
    const at = (s: number) => 8 * Math.exp(-120 * s) * Math.sin(2 * Math.PI * 250 * s);
    const wave = wave_m_s2([mode], 0.016, t);
    expect([...wave]).toEqual([0, 0, expect.closeTo(at(0.001), 12), expect.closeTo(at(0.013), 12), 0]);
  });

  it("adds its modes, and never leaves the sum of their envelopes", () => {
    const other = { frequency_Hz: 610, amplitude_m_s2: -3, decay_1_s: 0, phase_rad: 1.2 };
    const t = times_s([mode, other], 0.02);
    const both = wave_m_s2([mode, other], 0.02, t);
    const [a, b] = [wave_m_s2([mode], 0.02, t), wave_m_s2([other], 0.02, t)];
    const [ea, eb] = [envelope_m_s2(mode, t), envelope_m_s2(other, t)];
    both.forEach((value, i) => {
      expect(value).toBeCloseTo((a[i] as number) + (b[i] as number), 12);
      expect(Math.abs(value)).toBeLessThanOrEqual((ea[i] as number) + (eb[i] as number) + 1e-12);
    });
  });

  it("has times that end at the duration and hold a turn in twenty steps and more", () => {
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
    const heard = sound([mode], 0.016, 48000);
    expect(heard.length).toBe(769);
    expect(Math.max(...heard.map(Math.abs))).toBeCloseTo(0.8, 2);
    expect(heard.at(-1)).toBeCloseTo(0, 12);
  });

  it("of nothing is nothing", () => {
    expect(sound([{ ...mode, amplitude_m_s2: 0 }], 0.016, 48000)).toHaveLength(0);
  });
});
