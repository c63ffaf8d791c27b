import { describe, expect, it } from "vitest";
import { labelRoom_px, placeLabels } from "../../src/draw/labels";

const RANGE = { low: 10, high: 210 };
const HIGH = 14;
/** Places without order or pattern, the same in every run. */
const places = (count: number, seed: number) =>
  Array.from({ length: count }, (_, i) => 110 + 120 * Math.sin(seed * 12.9898 + i * 78.233));

describe("names at the ends of curves", () => {
  it("never overlap, stay inside, and keep the order of the curves", () => {
    for (let seed = 0; seed < 300; seed++) {
      const wanted = places(1 + (seed % 14), seed);
      const found = placeLabels(wanted, HIGH, RANGE) as number[];
      const order = wanted.map((_, i) => i).sort((a, b) => wanted[a]! - wanted[b]!);
      const sorted = order.map((i) => found[i]!);
      expect(Math.min(...sorted)).toBeGreaterThanOrEqual(RANGE.low + HIGH / 2 - 1e-6);
      expect(Math.max(...sorted)).toBeLessThanOrEqual(RANGE.high - HIGH / 2 + 1e-6);
      for (let i = 1; i < sorted.length; i++)
        expect(sorted[i]! - sorted[i - 1]!).toBeGreaterThanOrEqual(HIGH - 1e-6);
    }
  });

  it("stay where they are wanted if nothing is in the way", () => {
    expect(placeLabels([30, 60, 100], HIGH, RANGE)).toEqual([30, 60, 100]);
  });

  it("share a place that two want, no further away than needed", () => {
    expect(placeLabels([100, 100], HIGH, RANGE)).toEqual([93, 107]);
  });

  it("are left out where there is no room, the lightest first", () => {
    const found = placeLabels([20, 21, 22], HIGH, { low: 0, high: 30 }, [0, 1, 2]);
    expect(found[0]).toBeNull();
    expect(found.filter((one) => one !== null)).toHaveLength(2);
  });

  it("take at most a quarter of a plot, and nothing without names", () => {
    expect(labelRoom_px([], 800)).toBe(0);
    expect(labelRoom_px(["a name that goes on and on and on"], 300)).toBeLessThanOrEqual(78);
  });
});
