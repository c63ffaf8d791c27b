import { describe, expect, it } from "vitest";
import { stepped, toggled, united, within } from "../../src/tools/selection";

describe("a selection", () => {
  it("gains a point and loses it again", () => {
    expect(toggled([3], 1)).toEqual([1, 3]);
    expect(toggled([1, 3], 1)).toEqual([3]);
    expect(united([5, 1], [3, 1])).toEqual([1, 3, 5]);
  });

  it("steps along the curve and stops at its ends", () => {
    expect(stepped([2], 4, 1, false)).toEqual([3]);
    expect(stepped([3], 4, 1, false)).toEqual([3]);
    expect(stepped([0], 4, -1, false)).toEqual([0]);
    expect(stepped([1, 2], 4, 1, true)).toEqual([1, 2, 3]);
    expect(stepped([1, 2], 4, -1, true)).toEqual([0, 1, 2]);
  });

  it("begins at the end it is stepped from", () => {
    expect(stepped([], 4, 1, false)).toEqual([0]);
    expect(stepped([], 4, -1, false)).toEqual([3]);
    expect(stepped([], 0, 1, false)).toEqual([]);
  });

  it("loses points that are no more", () => {
    expect(within([0, 3, 9], 4)).toEqual([0, 3]);
  });
});
