import { describe, expect, it } from "vitest";
import type { LibraryIndex } from "../../../src/net/messages";
import { Rows } from "../../../src/pages/library/rows";

function index(epoch: number, first: number, names: readonly string[]): LibraryIndex {
  const tenths = Int16Array.from({ length: 128 * names.length }, (_, i) =>
    i % 128 < 64 ? 10 * (i % 64) : -32768,
  );
  const binary = String.fromCharCode(...new Uint8Array(tenths.buffer));
  return {
    standing: {
      type: "standing",
      epoch,
      rows: 0,
      refused: 0,
      done: 0,
      total: 0,
      ended: true,
      sources: 0,
      trouble: "",
    },
    first,
    ids: names.map((name) => `own:${name}`),
    names,
    collections: names.map(() => ""),
    origins: names.map(() => "own"),
    kinds: names.map(() => "linear"),
    stated: names.map(() => []),
    speeds_mm_s: names.map(() => []),
    dates: names.map(() => null),
    simulated: names.map(() => false),
    numbers: { travel_mm: names.map((_, i) => 3 + i), peak_cN: names.map(() => null) },
    sketches: btoa(binary),
  };
}

describe("rows", () => {
  it("grow at their end, and are found by id", () => {
    const rows = new Rows();
    rows.take(index(1, 0, ["a", "b"]));
    rows.take(index(1, 2, ["c"]));
    expect([rows.length, rows.at("own:c"), rows.at("own:none")]).toEqual([3, 2, -1]);
    expect(rows.number("travel_mm", 1)).toBe(4);
    expect(rows.number("peak_cN", 1)).toBeNull();
    expect(rows.number("weight", 1)).toBeNull();
  });

  it("are replaced as a whole when the index was", () => {
    const rows = new Rows();
    rows.take(index(1, 0, ["a", "b"]));
    rows.take(index(2, 0, ["c"]));
    expect([rows.epoch, rows.length, rows.at("own:a"), rows.at("own:c")]).toEqual([2, 1, -1, 0]);
  });

  it("that do not follow on are not mixed in", () => {
    const rows = new Rows();
    rows.take(index(1, 0, ["a"]));
    rows.take(index(2, 5, ["f"]));
    expect(rows.length).toBe(0);
  });

  it("give sketches in cN, and none where a stroke was not measured", () => {
    const rows = new Rows();
    rows.take(index(1, 0, ["a"]));
    expect(rows.sketch_cN(0, "press")?.[63]).toBe(63);
    expect(rows.sketch_cN(0, "release")).toBeNull();
    expect(rows.sketch_cN(7, "press")).toBeNull();
  });
});
