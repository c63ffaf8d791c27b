import { describe, expect, test } from "vitest";
import { bumpOf, controlPoints_mm, curvesOf, drop_cN, force_cN } from "../../../src/math";
import { addPoint, applyEdit, type FDVVModel, movePoints } from "../../../src/model";
import { pointsToMove, pullAll } from "../../../src/pages/edit/every_speed";
import { builtIn } from "../../golden/golden";

const CLEAR = builtIn("mx-clear");
const presses = (model: FDVVModel) => curvesOf(model, "press");
const draggedIn = (model: FDVVModel) => {
  const [curve, ...followers] = presses(model);
  return { curve: curve!, followers };
};

describe("a drag that every speed follows", () => {
  test("moves the nearest point of each by the same force, whatever number of points it has", () => {
    const { stroke, velocity_mm_s } = presses(CLEAR)[1]!;
    const model = applyEdit(CLEAR, addPoint({ stroke, velocity_mm_s }, 0.4));
    const points = pointsToMove(draggedIn(model), [5]);
    const made = applyEdit(model, movePoints(points, 7));
    const at_mm = controlPoints_mm(presses(model)[0]!)[5]!;
    for (const [n, curve] of presses(model).entries()) {
      const by = presses(made)[n]!.control_points_cN.map((cN, i) => cN - curve.control_points_cN[i]!);
      const moved = by.flatMap((cN, i) => (Math.abs(cN) > 1e-9 ? [i] : []));
      expect(moved).toHaveLength(1);
      expect(by[moved[0]!]).toBeCloseTo(7, 9);
      const away = Array.from(controlPoints_mm(curve), (x) => Math.abs(x - at_mm));
      expect(away[moved[0]!]).toBe(Math.min(...away));
    }
    expect(curvesOf(made, "release")).toEqual(curvesOf(model, "release"));
  });

  test("pulls every curve through the same force at a place", () => {
    const options = { constraints: {}, travel_mm: CLEAR.travel_mm };
    const made = applyEdit(CLEAR, pullAll(draggedIn(CLEAR), 2.2, -5, options));
    for (const [n, curve] of presses(CLEAR).entries())
      expect(force_cN(presses(made)[n]!, [2.2])[0]! - force_cN(curve, [2.2])[0]!).toBeCloseTo(-5, 6);
  });

  test("raises each curve's own peak: a click that comes later at speed stays there", () => {
    const before = presses(CLEAR).map((curve) => bumpOf(curve, CLEAR.travel_mm)!);
    const options = { constraints: {}, travel_mm: CLEAR.travel_mm, bump: "peak" };
    const made = applyEdit(CLEAR, pullAll(draggedIn(CLEAR), before[0]!.peak_mm, 6, options));
    for (const [n, curve] of presses(made).entries()) {
      const after = bumpOf(curve, CLEAR.travel_mm)!;
      expect(drop_cN(after) - drop_cN(before[n]!)).toBeGreaterThan(3);
      expect(Math.abs(after.peak_mm - before[n]!.peak_mm)).toBeLessThan(0.1);
    }
  });
});
