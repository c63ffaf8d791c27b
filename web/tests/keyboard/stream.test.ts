import { describe, expect, it } from "vitest";
import { Depths } from "../../src/keyboard/depths";
import { type Recording, readRecording, recordingText } from "../../src/keyboard/recording";
import { simulatedRecording } from "../../src/keyboard/simulated";

const step_mm = 4 / 255;
const stepped = (mm: number) => Math.round(mm / step_mm) * step_mm;

describe("the speed of a key", () => {
  it("is found from a sensor of eight bits, within 2 mm/s of a steady motion", () => {
    for (const mm_s of [-200, -40, 5, 100, 400]) {
      const depths = new Depths();
      const from_mm = mm_s < 0 ? 4 : 0;
      let worst = 0;
      for (let t = 0; Math.abs((mm_s * t) / 1000) < 4; t++) {
        const { velocity_mm_s } = depths.add(t, stepped(from_mm + (mm_s * t) / 1000));
        if (t > 12) worst = Math.max(worst, Math.abs(velocity_mm_s - mm_s));
      }
      expect(worst).toBeLessThan(2);
    }
  });

  it("is that of half its window ago when a key speeds up", () => {
    const depths = new Depths();
    let found = 0;
    for (let t = 0; t <= 60; t += 0.5) found = depths.add(t, 0.5e-3 * t * t).velocity_mm_s;
    expect(found).toBeCloseTo(60 - 6, 1);
  });

  it("is nothing after a silence, before a second reading, and at two readings of one time", () => {
    const depths = new Depths();
    expect(depths.now(0)).toBeNull();
    expect(depths.add(0, 1).velocity_mm_s).toBe(0);
    expect(depths.add(0, 2).velocity_mm_s).toBe(0);
    expect(depths.add(5, 3).velocity_mm_s).toBeGreaterThan(100);
    expect(depths.now(46)?.velocity_mm_s).toBe(0);
    expect(depths.add(1000, 3.5).velocity_mm_s).toBe(0);
  });

  it("turns its stroke once the key went back, not with noise", () => {
    const depths = new Depths();
    const strokes = [0, 1, 1.02, 0.98, 1.5, 1.46, 1.44, 1.2, 1.22, 1.26].map(
      (mm, i) => depths.add(i, mm).stroke,
    );
    expect(strokes).toEqual([...Array(6).fill("press"), ...Array(3).fill("release"), "press"]);
  });
});

describe("the readings of a key", () => {
  it("are given from a time on, with the one that held then, and are never too many", () => {
    const depths = new Depths();
    for (let t = 0; t < 100; t++) depths.add(t, t / 25);
    expect(depths.since(97).t_ms).toEqual([96, 97, 98, 99]);
    const some = depths.since(0, 20);
    expect(some.t_ms.length).toBeLessThanOrEqual(21);
    expect(some.t_ms.at(-1)).toBe(99);
    expect(depths.rate_Hz()).toBeCloseTo(1000, 6);
    expect(new Depths().rate_Hz()).toBe(0);
  });

  it("are forgotten when there are too many, oldest first", () => {
    const depths = new Depths();
    for (let t = 0; t < 90_000; t++) depths.add(t, 0);
    const { t_ms } = depths.since(-1);
    expect([t_ms[0], t_ms.length]).toEqual([50_000, 40_000]);
  });
});

describe("a recording of a key", () => {
  const made: Recording = {
    device: "Wooting 60HE",
    key: "Space",
    rate_Hz: 1000,
    full_scale_mm: 3.8,
    simulated: "",
    t_ms: [0, 1, 2.25, 2.25, 4],
    depth_mm: [0, 0.0157, 2, 2.5, 0],
  };

  it("is read as it was written", () => {
    expect(readRecording(recordingText(made), "mine.csv")).toEqual(made);
    const simulated = simulatedRecording();
    const again = readRecording(recordingText(simulated), "simulated.csv");
    expect(again.simulated).toContain("drawn hand");
    expect(
      Math.max(...again.t_ms.map((t, i) => Math.abs(t - simulated.t_ms[i]! + simulated.t_ms[0]!))),
    ).toBeLessThan(0.011);
    expect(Math.max(...again.depth_mm.map((mm, i) => Math.abs(mm - simulated.depth_mm[i]!)))).toBeLessThan(
      1e-4,
    );
  });

  it("begins at 0, whatever its first time", () => {
    const later = recordingText({ ...made, t_ms: made.t_ms.map((t) => t + 50) });
    expect(readRecording(later, "mine.csv").t_ms).toEqual(made.t_ms);
  });

  it("that is wrong is refused in one line with file and place", () => {
    const text = recordingText(made);
    const refused = (wrong: string) => {
      try {
        readRecording(wrong, "mine.csv");
        return "";
      } catch (error) {
        return (error as Error).message;
      }
    };
    expect(refused("t_s,displacement_mm\n0,0\n")).toBe(
      'mine.csv: line 1: a recording of a key begins with "# fdvv key recording 1"',
    );
    expect(refused(text.replace("t_ms,depth_mm", "t_ms"))).toBe(
      "mine.csv: line 6: the columns t_ms,depth_mm are missing",
    );
    expect(refused("# fdvv key recording 1")).toMatch(/line 1: the columns/);
    expect(refused(text.replace("\n1,", "\nsoon,"))).toMatch(/line 8: "soon,0.0157" is no pair of numbers/);
    expect(refused(text.replace("\n1,", "\n,"))).toMatch(/line 8: .* is no pair/);
    expect(refused(text.replace("2.25,2\n", "2.25,20\n"))).toMatch(/line 9: 20 mm is deeper/);
    expect(refused(text.replace("\n4,0", "\n1,0"))).toMatch(/line 11: its time is before/);
    expect(refused(text.replace("\n4,0", "\n140000,0"))).toMatch(/line 11: a recording lasts 120 s/);
    expect(refused(text.split("\n").slice(0, 8).join("\n"))).toMatch(/2 rows; a recording needs 4/);
    expect(refused("x".repeat(4_000_001))).toBe("mine.csv is larger than 4 MB; record less");
  });
});

describe("the simulated recording", () => {
  const { t_ms, depth_mm, full_scale_mm, simulated } = simulatedRecording();

  it("says that it is one, and is the same every time", () => {
    expect(simulated).not.toBe("");
    expect(simulatedRecording().depth_mm).toEqual(depth_mm);
    expect(simulatedRecording(2).depth_mm).not.toEqual(depth_mm);
  });

  it("is what a sensor of 8 bits reads: its steps, its range, rising times", () => {
    for (const mm of depth_mm) expect(Math.abs(mm / step_mm - Math.round(mm / step_mm))).toBeLessThan(1e-9);
    expect([Math.min(...depth_mm), Math.max(...depth_mm)]).toEqual([0, full_scale_mm]);
    expect(t_ms.every((t, i) => !i || t >= t_ms[i - 1]!)).toBe(true);
    expect(t_ms.at(-1)! / 1000).toBeLessThan(4);
  });
});
