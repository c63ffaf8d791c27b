import { describe, expect, test } from "vitest";
import { bumpOf, curvesOf, drop_cN, force_cN } from "../../src/math";
import { applyEdit, scaleBase, scaleBump, scaleForce, stretchTravel } from "../../src/model";
import { builtIn } from "../golden/golden";
import { expectNear } from "../math/near";

const CLEAR = builtIn("mx-clear");
const press = (model: typeof CLEAR) => curvesOf(model, "press").find((c) => c.velocity_mm_s === 100)!;
const bump = (model: typeof CLEAR) => bumpOf(press(model), model.travel_mm)!;

describe("a button as a whole", () => {
  test("has twice the force everywhere when its force is doubled", () => {
    const made = applyEdit(CLEAR, scaleForce(2));
    const x = [0.5, 1, 2, 3, 3.9];
    for (const [i, curve] of made.curves.entries()) {
      expectNear(
        force_cN(curve, x),
        Array.from(force_cN(CLEAR.curves[i]!, x), (f) => 2 * f),
      );
    }
  });

  test("becomes lighter and keeps its bump", () => {
    const made = applyEdit(CLEAR, scaleBase(0.8));
    expect(bump(made).peak_cN).toBeLessThan(0.9 * bump(CLEAR).peak_cN);
    expect(drop_cN(bump(made))).toBeGreaterThan(0.9 * drop_cN(bump(CLEAR)));
  });

  test("clicks more at the same mean force", () => {
    const made = applyEdit(CLEAR, scaleBump(1.4));
    expect(drop_cN(bump(made))).toBeGreaterThan(1.3 * drop_cN(bump(CLEAR)));
    const mean = (model: typeof CLEAR) => {
      const points = press(model).control_points_cN;
      return points.reduce((sum, c) => sum + c, 0) / points.length;
    };
    expect(Math.abs(mean(made) - mean(CLEAR))).toBeLessThan(0.05 * mean(CLEAR));
  });

  test("never pulls where it did not", () => {
    for (const edit of [scaleBase(0.5), scaleBump(1.5)]) {
      applyEdit(CLEAR, edit).curves.forEach((curve, i) => {
        const before = CLEAR.curves[i]!.control_points_cN;
        expect(curve.control_points_cN.every((c, k) => c >= Math.min(0, before[k]!))).toBe(true);
      });
    }
  });

  test("stays as it is when it is scaled by one", () => {
    for (const edit of [scaleForce(1), scaleBase(1), scaleBump(1)]) {
      const made = applyEdit(CLEAR, edit);
      made.curves.forEach((c, i) => {
        expectNear(c.control_points_cN, CLEAR.curves[i]!.control_points_cN);
      });
    }
  });

  test("stretches with its travel: every place keeps its part and its force", () => {
    const made = applyEdit(CLEAR, stretchTravel(2));
    expect(made.travel_mm).toBe(2);
    expect(made.actuation_mm).toBe(0.5 * CLEAR.actuation_mm!);
    expect(made.vibrations[0]!.onset_mm).toBeCloseTo(0.5 * CLEAR.vibrations[0]!.onset_mm);
    expectNear(force_cN(press(made), [0.5, 1, 1.9]), Array.from(force_cN(press(CLEAR), [1, 2, 3.8])));
  });

  test("changes one curve where one is meant", () => {
    const made = applyEdit(CLEAR, scaleForce(2, { stroke: "press", velocity_mm_s: 100 }));
    const changed = made.curves.filter(
      (c, i) => c.control_points_cN[3] !== CLEAR.curves[i]!.control_points_cN[3],
    );
    expect(changed.map((c) => [c.stroke, c.velocity_mm_s])).toEqual([["press", 100]]);
  });
});
