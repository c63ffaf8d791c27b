import { describe, expect, it, vi } from "vitest";
import type { Sample } from "../../../src/keyboard/depths";
import { newest } from "../../../src/keyboard/newest";
import { forceOf, forcesAt } from "../../../src/pages/press/key_forces";

const displacement_mm = [0, 1, 2];
const at = (velocity_mm_s: number, scale: number) => ({
  type: "meant" as const,
  velocity_mm_s,
  displacement_mm,
  press_cN: [0, 40 * scale, 60 * scale],
  release_cN: [0, 20 * scale, 50 * scale],
});
const SPEEDS = [at(0, 1), at(100, 2), at(200, 2.5)];
const key = (depth_mm: number, stroke: Sample["stroke"] = "press"): Sample => ({
  t_ms: 0,
  depth_mm,
  velocity_mm_s: 0,
  stroke,
});

describe("the force of a button under a key", () => {
  it("is that of a listed speed, in between on a line, and of the fastest beyond", () => {
    expect(forcesAt(SPEEDS, 0)?.press_cN).toEqual([0, 40, 60]);
    expect(forcesAt(SPEEDS, 100)?.press_cN).toEqual([0, 80, 120]);
    expect(forcesAt(SPEEDS, -50)?.release_cN).toEqual([0, 30, 75]);
    expect(forcesAt(SPEEDS, 900)?.press_cN).toEqual([0, 100, 150]);
    expect(forcesAt([], 50)).toBeNull();
  });

  it("is that of the stroke and the place", () => {
    const slow = forcesAt(SPEEDS, 0)!;
    expect(forceOf(slow, key(0.5))).toBe(20);
    expect(forceOf(slow, key(1.5, "release"))).toBe(35);
    expect(forceOf(slow, key(2))).toBe(60);
    expect(forceOf(slow, key(-0.1))).toBe(0);
  });

  it("is not known beyond the stop", () => {
    expect(forceOf(forcesAt(SPEEDS, 0)!, key(2.1))).toBeNull();
  });
});

describe("readings that come faster than they are passed on", () => {
  it("pass the first at once, then the newest now and then, and the last one always", () => {
    vi.useFakeTimers();
    const passed: number[] = [];
    const pass = newest<number>(4, (value) => passed.push(value));
    for (let t = 1; t <= 10; t++) {
      pass(t);
      vi.advanceTimersByTime(1);
    }
    vi.advanceTimersByTime(50);
    expect(passed).toEqual([1, 4, 8, 10]);
    pass(11);
    vi.advanceTimersByTime(50);
    expect(passed).toEqual([1, 4, 8, 10, 11]);
    vi.useRealTimers();
  });
});
