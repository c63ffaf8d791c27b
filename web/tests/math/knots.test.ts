import { expect, test } from "vitest";
import {
  addPoint,
  force_cN,
  forceAt_cN,
  insertKnot,
  linspace,
  refit,
  removePoint,
  type Spline,
  uniformKnots,
} from "../../src/math";
import { builtIn, golden } from "../golden/golden";
import { expectNear } from "./near";

const splines = golden<Spline>("splines");
const clear = builtIn("mx-clear").curves[0]!;
const x = linspace(0, 4, 801);

test("adding a point anywhere leaves the shape", () => {
  for (const curve of splines) {
    for (const at of [0.013, 1, 2.2, 3.999]) {
      const made = addPoint(curve, at);
      expect(made.control_points_cN.length).toBe(curve.control_points_cN.length + 1);
      expectNear(force_cN(made, x), force_cN(curve, x));
    }
  }
});

test("a point added on a knot goes beside it, so that the curve stays smooth", () => {
  const made = addPoint(clear, 2);
  expect([...made.knots_mm].filter((t) => t === 2)).toHaveLength(1);
  expect([...made.knots_mm]).toContain(1.85);
});

test("the new point is the one nearest to the place", () => expect(addPoint(clear, 1.0).index).toBe(4));

test("a point outside the curve is refused", () => {
  expect(() => addPoint(clear, 4)).toThrow("a control point goes inside the curve, 0 to 4 mm, got 4");
});

test("removing what insertion added gives the curve back", () => {
  for (const curve of splines) {
    const { knots_mm, control_points_cN } = insertKnot(curve, 1.234);
    const more = { degree: curve.degree, knots_mm, control_points_cN };
    const index = [...knots_mm].indexOf(1.234) - 1;
    const back = removePoint(more, index);
    expect(back.largest_cN).toBeLessThan(1e-9);
    expectNear(force_cN(back, x), force_cN(curve, x));
  }
});

test("removing a point changes the curve by no more than it says, and only near it", () => {
  for (let i = 0; i < clear.control_points_cN.length; i++) {
    const made = removePoint(clear, i);
    const [before, after] = [force_cN(clear, x), force_cN(made, x)];
    const worst = Math.max(...after.map((f, j) => Math.abs(f - before[j]!)));
    expect(worst).toBeLessThanOrEqual(made.largest_cN * 1.01 + 1e-9);
    expect(made.largest_cN).toBeLessThanOrEqual(worst * 1.05 + 1e-9);
    expect([after[0], after[800]]).toEqual([before[0], before[800]]);
  }
  const first = removePoint(clear, 1);
  expect(forceAt_cN(first, 3)).toBeCloseTo(forceAt_cN(clear, 3), 9);
});

test("no other free points do better, in least squares, than those that removal finds", () => {
  const made = removePoint(clear, 6);
  const wanted = force_cN(clear, x);
  const error = (c: ArrayLike<number>) =>
    force_cN({ ...made, control_points_cN: c }, x).reduce((sum, f, i) => sum + (f - wanted[i]!) ** 2, 0);
  const least = error(made.control_points_cN);
  const before = clear.control_points_cN;
  const moved = [...made.control_points_cN.keys()].filter((i) => {
    const c = made.control_points_cN[i];
    return c !== before[i] && c !== before[i + 1];
  });
  expect(moved.length).toBeGreaterThan(0);
  for (const i of moved) {
    for (const step of [-0.2, 0.2]) {
      const other = Float64Array.from(made.control_points_cN);
      other[i] = other[i]! + step;
      expect(error(other)).toBeGreaterThan(least);
    }
  }
});

test("a curve with no point to spare keeps them", () => {
  const bare = { degree: 3, knots_mm: uniformKnots(0, 1, 4, 3), control_points_cN: [1, 2, 3, 4] };
  expect(() => removePoint(bare, 1)).toThrow(
    "degree 3 needs at least 4 control points, the curve has no more",
  );
});

test("a refit on knots that hold the curve's own is the curve", () => {
  const { knots_mm } = insertKnot(clear, 0.1);
  const made = refit(clear, knots_mm);
  expect(made.largest_cN).toBeLessThan(1e-9);
  expect(refit(clear, uniformKnots(0, 4, 8, 3)).largest_cN).toBeGreaterThan(1);
});

test("a refit is nearer the more knots it has", () => {
  const errors = [6, 12, 24, 48].map((n) => refit(clear, uniformKnots(0, 4, n, 3)).largest_cN);
  expect([...errors].sort((a, b) => b - a)).toEqual(errors);
});
