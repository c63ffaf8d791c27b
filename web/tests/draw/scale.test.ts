import { describe, expect, it } from "vitest";
import { csv } from "../../src/draw/file";
import { linear, rangeOf, tickStep, ticks, tickText } from "../../src/draw/scale";

describe("a scale", () => {
  it("leads to the screen and back", () => {
    const scale = linear({ low: -1, high: 4 }, 300, 20);
    for (const value of [-1, 0, 1.234, 4, 9]) expect(scale.value(scale.px(value))).toBeCloseTo(value, 12);
    expect([scale.px(-1), scale.px(4)]).toEqual([300, 20]);
  });

  it("has ticks that are round, inside and evenly apart", () => {
    for (let n = 0; n < 500; n++) {
      const low = Math.sin(n) * 10 ** ((n % 7) - 3);
      const range = { low, high: low + (1 + Math.cos(n * 3) ** 2) * 10 ** ((n % 5) - 2) };
      const step = tickStep(range, 6);
      const found = ticks(range, 6);
      expect(found.length).toBeGreaterThanOrEqual(2);
      expect(found.length).toBeLessThanOrEqual(8);
      expect([1, 2, 5]).toContain(Math.round(step / 10 ** Math.floor(Math.log10(step) + 1e-9)));
      for (const at of found) {
        expect(at).toBeGreaterThanOrEqual(range.low - step * 1e-6);
        expect(at).toBeLessThanOrEqual(range.high + step * 1e-6);
      }
    }
  });

  it("writes ticks with the decimals of their step", () => {
    expect([
      tickText(0.30000000000000004, 0.1),
      tickText(-2, 1),
      tickText(1e-17, 0.5),
      tickText(20, 10),
    ]).toEqual(["0.3", "−2", "0.0", "20"]);
  });

  it("gives the range of what is finite", () => {
    expect(rangeOf([[1, NaN, 3], [2]], 0)).toEqual({ low: 1, high: 3 });
    expect(rangeOf([[NaN], []])).toBeNull();
  });
});

describe("CSV", () => {
  it("quotes what needs it, and leaves nothing that a sheet would run", () => {
    const text = csv([
      ["name", ['a "b", c', "=1+1", "-x"]],
      ["force_cN", [1.5, NaN]],
    ]);
    expect(text).toBe('name,force_cN\n"a ""b"", c",1.5\n\'=1+1,\n\'-x,\n');
  });
});
