import { describe, expect, test } from "vitest";
import {
  basis,
  checkSpline,
  evaluate,
  findSpan,
  greville,
  insertKnot,
  ModelError,
  uniformKnots,
} from "../../src/math";
import { golden } from "../golden/golden";
import { expectNear } from "./near";

interface Case {
  readonly degree: number;
  readonly knots_mm: number[];
  readonly control_points_cN: number[];
  readonly control_points_mm: number[];
  readonly x_mm: number[];
  readonly force_cN: number[];
  readonly stiffness_cN_mm: number[];
  readonly inserted_mm: number;
  readonly inserted_knots_mm: number[];
  readonly inserted_points_cN: number[];
}

describe.each(golden<Case>("splines").map((one, i) => [i, one] as const))("spline %i", (_, one) => {
  const { degree: k, knots_mm: t, control_points_cN: c } = one;

  test("has the values and slopes of SciPy's, end values outside", () => {
    expectNear(evaluate(t, c, k, one.x_mm), one.force_cN);
    expectNear(evaluate(t, c, k, one.x_mm, 1), one.stiffness_cN_mm);
  });

  test("does not care in which order it is asked", () => {
    const x = [...one.x_mm].reverse();
    expect([...evaluate(t, c, k, x)].reverse()).toEqual([...evaluate(t, c, k, one.x_mm)]);
  });

  test("has its control points where Python draws them", () =>
    expectNear(greville(t, k), one.control_points_mm));

  test("gains a knot as SciPy inserts it", () => {
    const made = insertKnot(one, one.inserted_mm);
    expect([...made.knots_mm]).toEqual(one.inserted_knots_mm);
    expectNear(made.control_points_cN, one.inserted_points_cN);
  });

  test("has basis functions that add up to one and to the value", () => {
    for (const x of one.x_mm.filter((at) => at >= 0 && at <= 4)) {
      const i = findSpan(t, k, x);
      const b = basis(t, k, i, x);
      expectNear([b.reduce((sum, value) => sum + value, 0)], [1], 1e-14);
      expectNear(
        [b.reduce((sum, value, j) => sum + value * c[i - k + j]!, 0)],
        evaluate(t, c, k, [x]),
        1e-12,
      );
    }
  });
});

test("uniform knots are those of numpy", () => {
  expect([...uniformKnots(0, 4, 6, 3)]).toEqual([0, 0, 0, 0, 4 / 3, 8 / 3, 4, 4, 4, 4]);
  expect(() => checkSpline(uniformKnots(0, 4, 9, 5), new Float64Array(9), 5)).not.toThrow();
});

test.each([
  ["degree must be 1 to 5, got 6", [0, 1], [1], 6],
  ["degree 3 needs at least 4 control points, got 3", [0, 0, 0, 0, 1, 1, 1, 1], [1, 2, 3], 3],
  ["2 control points of degree 1 need 4 knots, got 3", [0, 0, 1], [1, 2], 1],
  ["knots_mm must not fall", [0, 0, 2, 1, 3, 3], [1, 2, 3, 4], 1],
  ["the first and last 2 knots must be equal", [0, 1, 2, 2], [1, 2], 1],
  [
    "no knot may repeat more than 2 times and the curve needs a length",
    [0, 0, 1, 1, 1, 2, 2],
    [1, 2, 3, 4, 5],
    1,
  ],
])("%s", (line, t, c, k) => {
  expect(() => checkSpline(t, c, k)).toThrow(new ModelError(line));
});
