import { describe, expect, it } from "vitest";
import { walked } from "../../src/tools/grid";
import { typed } from "../../src/tools/typed";

describe("a typed number", () => {
  it("may have a comma, a sign and an exponent", () => {
    expect(["1.5", " 1,5 ", "−2", "+.5", "3.", "1e-3"].map(typed)).toEqual([1.5, 1.5, -2, 0.5, 3, 0.001]);
  });

  it("is nothing else", () => {
    expect(["", "a", "1.2.3", "0x10", "Infinity", "1e999", "--1", "1 2"].map(typed)).toEqual(
      Array(8).fill(null),
    );
  });
});

describe("walking a table", () => {
  const extent = { rows: 5, columns: 3, page: 2 };
  const at = { row: 2, column: 1 };

  it("goes a cell, a page, to the ends and the corners", () => {
    const to = (key: string, ctrl = false) => Object.values(walked(at, key, ctrl, extent) ?? {});
    expect(to("ArrowUp")).toEqual([1, 1]);
    expect(to("Enter")).toEqual([3, 1]);
    expect(to("ArrowDown", true)).toEqual([4, 1]);
    expect(to("PageUp")).toEqual([0, 1]);
    expect(to("Home")).toEqual([2, 0]);
    expect(to("End", true)).toEqual([4, 2]);
    expect(to("x")).toEqual([]);
  });

  it("never leaves the table", () => {
    for (const key of [
      "ArrowUp",
      "ArrowDown",
      "ArrowLeft",
      "ArrowRight",
      "PageUp",
      "PageDown",
      "Home",
      "End",
    ]) {
      for (const row of [0, 4]) {
        for (const column of [0, 2]) {
          const cell = walked({ row, column }, key, false, extent);
          expect(cell?.row).toBeGreaterThanOrEqual(0);
          expect(cell?.row).toBeLessThan(5);
          expect(cell?.column).toBeGreaterThanOrEqual(0);
          expect(cell?.column).toBeLessThan(3);
        }
      }
    }
  });
});
