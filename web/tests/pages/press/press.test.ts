import { describe, expect, it } from "vitest";
import { parseRoute } from "../../../src/app/route";
import { wavOf } from "../../../src/math/wav";
import { Latency } from "../../../src/pages/press/latency";
import { choiceOf, type Pick, pickOf } from "../../../src/pages/press/picks";
import { Rolling } from "../../../src/pages/press/rolling";
import { loudness, Steady } from "../../../src/pages/press/sound";
import { sentence } from "../../../src/pages/press/verdict";

describe("the rows of a live press", () => {
  it("are given from a time on, oldest first, the last one always", () => {
    const rows = new Rolling();
    const t = Array.from({ length: 100 }, (_, i) => i / 1000);
    rows.add(
      t,
      t.map((x) => 2 * x),
      t.map((x) => 3 * x),
    );
    expect(rows.now_s()).toBeCloseTo(0.099);
    const some = rows.since(0.09, 4);
    expect(some.t_s).toEqual([0.092, 0.096, 0.099]);
    expect(some.force_cN[0]).toBeCloseTo(0.276);
  });

  it("are forgotten when there are too many, never mixed up", () => {
    const rows = new Rolling();
    for (let block = 0; block < 70; block++) {
      const t = Array.from({ length: 1000 }, (_, i) => (block * 1000 + i) / 1000);
      rows.add(t, t, t);
    }
    const all = rows.since(-1);
    expect(all.t_s.length).toBe(30_000);
    expect(all.t_s[0]).toBeCloseTo(40);
    expect(all.t_s.every((t, i) => i === 0 || t > (all.t_s[i - 1] as number))).toBe(true);
  });

  it("are none after clearing", () => {
    const rows = new Rolling();
    rows.add([1], [1], [1]);
    rows.clear();
    expect(rows.since(0).t_s).toEqual([]);
    expect(rows.now_s()).toBe(0);
  });
});

describe("the delay from hand to screen", () => {
  it("counts from the first move that a drawn frame took into account", () => {
    const latency = new Latency();
    latency.sent(1, 100);
    latency.sent(2, 108);
    expect(latency.drawn(2, 130)).toBe(30);
    expect(latency.drawn(2, 146)).toBeNull();
    latency.sent(3, 150);
    expect(latency.drawn(3, 160)).toBe(10);
    expect(latency.summary()).toEqual({ count: 2, median_ms: 30, p95_ms: 30, p99_ms: 30 });
  });

  it("says nothing before there was a move", () => {
    expect(new Latency().summary()).toBeNull();
  });
});

describe("the click", () => {
  it("is as loud as the press is fast, within bounds, whichever way", () => {
    expect(loudness(100)).toBe(1);
    expect(loudness(-50)).toBe(0.5);
    expect(loudness(0)).toBeCloseTo(1 / 3);
    expect(loudness(5000)).toBe(3);
  });

  it("is timed by the quickest frames, so that late ones do not shift it", () => {
    const clock = new Steady();
    for (const late_s of [0.012, 0.004, 0.07, 0.009, 0.03]) clock.take(5 + late_s);
    expect(clock.now_s()).toBeCloseTo(5.004, 4);
  });

  it("follows at once when a clock stood still, and puts one late frame right with the next", () => {
    const clock = new Steady();
    clock.take(5);
    clock.take(9);
    expect(clock.now_s()).toBe(9);
    clock.take(5.001);
    expect(clock.now_s()).toBe(5.001);
  });

  it("is written as a file that says what it holds", async () => {
    const bytes = new DataView(wavOf(Float32Array.of(0, 0.5, -1), 48_000, "float32"));
    expect(bytes.byteLength).toBe(56);
    expect(bytes.getUint32(24, true)).toBe(48_000);
    expect(bytes.getUint32(40, true)).toBe(12);
    expect(bytes.getFloat32(48, true)).toBe(0.5);
  });
});

describe("what is pressed", () => {
  const pick = (item: string): Pick => ({ item, mode: "intended", rig: "recommended" });

  it("keeps every part of an id", () => {
    expect(choiceOf(pick("button own:my key: two")).what).toEqual({ button: "own:my key: two" });
    expect(choiceOf(pick("program shipped:multi-level")).what).toEqual({ program: "shipped:multi-level" });
  });

  it("is what was chosen last on the page, else the button of the address, else the one worked on", () => {
    const at = (hash: string) => pickOf(parseRoute(hash), "own:Mine").item;
    expect(at("#/press/builtin:mx-red?press=program+shipped%3Abutton")).toBe("program shipped:button");
    expect(at("#/press/builtin:mx-red")).toBe("button builtin:mx-red");
    expect(at("#/press")).toBe("button own:Mine");
    expect(pickOf(parseRoute("#/press"), "").item).toBe("button builtin:mx-clear");
  });
});

describe("the sentence about a press", () => {
  const clicked = { displacement_mm: 1.93, force_cN: 61.4 };

  it("says where it clicked, under what force, and where it let go", () => {
    const said = sentence({ clicked, reset_mm: 1.62, deepest_mm: 3.9 });
    expect(said).toBe("Clicked at 1.9 mm under 61 cN; it let go at 1.6 mm.");
  });

  it("says that a key stayed down, and when it came up in a later press", () => {
    expect(sentence({ clicked, reset_mm: null, deepest_mm: 3.9 })).toMatch(/it stayed down\.$/);
    expect(sentence({ clicked: null, reset_mm: 0.5, deepest_mm: 2 })).toBe(
      "Pressed to 2 mm: it let go at 0.5 mm.",
    );
  });

  it("says what to do after a press without a click", () => {
    expect(sentence({ clicked: null, reset_mm: null, deepest_mm: 1.2 })).toMatch(/push harder/);
  });
});
