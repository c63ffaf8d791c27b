/** Delays from taps, and what is kept of them. */

// @vitest-environment jsdom
import { describe, expect, it } from "vitest";
import { AHEAD, tapped } from "../../../src/pages/optimize/taps";
import { displayDelay, FrameClock, readDelays } from "../../../src/play/delays";

describe("taps along with a flash", () => {
  it("tell how late they are, whatever the number of the flash, one that is far off left out", () => {
    const taps = Array.from({ length: 23 }, (_, i) => 5000 + 800 * i + 60 + (i % 2 ? 5 : -5));
    taps[10] = 5000 + 800 * 10 + 390;
    const found = tapped(taps, 5000, 800);
    expect(Math.abs((found?.late_ms ?? 0) - 60)).toBeLessThan(found?.late_error_ms ?? 0);
    expect(found?.both_ms).toBeCloseTo((found?.late_ms ?? 0) + AHEAD.ms, 9);
    expect(found?.both_error_ms).toBeGreaterThan(AHEAD.error_ms);
    expect(found?.both_error_ms).toBeLessThan(AHEAD.error_ms + 1);
  });

  it("may be early, and too few tell nothing", () => {
    const early = Array.from({ length: 12 }, (_, i) => 800 * (i + 1) - 30);
    expect(tapped(early, 0, 800)?.late_ms).toBeCloseTo(-30, 6);
    expect(tapped(early.slice(0, 8), 0, 800)).toBeNull();
  });
});

describe("delays", () => {
  it("of a screen follow its pace until somebody measures them", () => {
    const stated = readDelays(null);
    expect(displayDelay(stated, 1000 / 60)).toEqual({ ms: 30, error_ms: 1000 / 60 });
    expect(displayDelay({ ...stated, display: { ms: 80, error_ms: 3 } }, 7)).toEqual({ ms: 80, error_ms: 3 });
  });

  it.each([
    "",
    "{",
    "3",
    "{}",
    '{"display":{"ms":-1,"error_ms":0}}',
    '{"display":null,"input":{"key":{"ms":1e9,"error_ms":0}}}',
  ])("that a browser keeps wrongly (%s) are those that are stated", (text) =>
    expect(readDelays(text)).toEqual(readDelays(null)),
  );

  it("are read as they were kept", () => {
    const kept = { ...readDelays(null), display: { ms: 42, error_ms: 2 } };
    expect(readDelays(JSON.stringify(kept))).toEqual(kept);
  });

  it("are kept from before there were analog keys", () => {
    const { analog, ...before } = readDelays(null).input;
    const kept = { display: null, input: { ...before, key: { ms: 3, error_ms: 1 } } };
    expect(readDelays(JSON.stringify(kept)).input).toEqual({ ...kept.input, analog });
  });

  it("take the pace of a screen from its middle gap, so that one late picture changes nothing", () => {
    const pace = new FrameClock();
    expect(pace.frame_ms()).toBeCloseTo(16.67, 2);
    for (let i = 0; i < 30; i++) pace.take(i * 8 + (i > 20 ? 100 : 0));
    expect(pace.frame_ms()).toBe(8);
  });
});
