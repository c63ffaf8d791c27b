import { describe, expect, it } from "vitest";
import type { ScopeFrame } from "../../../src/net";
import { type ScopeBins, withBins, zigzag } from "../../../src/pages/live/scope";

const frame = (bin: number[], bin_s = 0.01): ScopeFrame => ({
  type: "scope",
  bin_s,
  bin,
  displacement_low_mm: bin.map((n) => n),
  displacement_high_mm: bin.map((n) => n + 0.5),
  force_low_cN: bin.map(() => null),
  force_high_cN: bin.map(() => null),
  commanded_low_cN: bin.map(() => 0),
  commanded_high_cN: bin.map(() => 1),
  state: bin.map(() => 0),
  cut: bin.map(() => false),
  ticks: bin.map(() => 10),
});

const empty = (bin_s: number): ScopeBins => ({ bin_s, bins: [] });

describe("the scope", () => {
  it("forgets what is out of sight", () => {
    const kept = withBins(withBins(empty(0.01), frame([1, 2, 3]), 3), frame([4, 5]), 3);
    expect(kept.bins.map(({ bin }) => bin)).toEqual([3, 4, 5]);
    expect(kept.bins.map(({ displacement_mm }) => displacement_mm)).toEqual([
      [3, 3.5],
      [4, 4.5],
      [5, 5.5],
    ]);
  });

  it("takes no bins of another width", () => {
    expect(withBins(empty(0.01), frame([1], 0.02), 10).bins).toEqual([]);
  });

  it("draws the least and the most of every bin, and breaks where ticks are missing", () => {
    const kept = withBins(empty(0.5), frame([1, 2, 5], 0.5), 10);
    expect(zigzag(kept, "displacement_mm")).toEqual({
      t_s: [-2, -2, -1.5, -1.5, 0, 0, 0],
      value: [1, 1.5, 2, 2.5, NaN, 5, 5.5],
    });
    expect(zigzag(kept, "force_cN").value.every(Number.isNaN)).toBe(true);
  });
});
