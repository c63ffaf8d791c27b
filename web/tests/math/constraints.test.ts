import { describe, expect, test } from "vitest";
import {
  constrain,
  force_cN,
  integral_cN_mm,
  integralWeights,
  keepWork,
  linspace,
  monotone,
  type Spline,
  trapezoid,
} from "../../src/math";
import { builtIn, golden } from "../golden/golden";
import { drawn, expectNear } from "./near";

const splines = golden<Spline>("splines");
const clear = builtIn("mx-clear").curves[0]!;

function randomRow(random: () => number, n: number): number[] {
  return Array.from({ length: n }, () => Math.round(random() * 200) / 4);
}

const squares = (a: ArrayLike<number>, b: ArrayLike<number>) =>
  Array.from(a).reduce((sum, value, i) => sum + (value - b[i]!) ** 2, 0);
const dot = (a: ArrayLike<number>, b: ArrayLike<number>) =>
  Array.from(a).reduce((sum, v, i) => sum + v * b[i]!, 0);
const rises = (c: ArrayLike<number>) => Array.from(c).every((v, i) => i === 0 || v >= c[i - 1]! - 1e-12);

/** Project by brute force: minimise by many small steps of coordinate descent over the run values. */
function slowIsotonic(y: readonly number[]): number[] {
  // min-max formula: the i-th value is the largest over a <= i of the least over b >= i of the mean of y[a..b]
  return y.map((_, i) => {
    let best = -Infinity;
    for (let a = 0; a <= i; a++) {
      let least = Infinity;
      for (let b = i; b < y.length; b++) {
        least = Math.min(least, y.slice(a, b + 1).reduce((s, v) => s + v, 0) / (b - a + 1));
      }
      best = Math.max(best, least);
    }
    return best;
  });
}

describe("monotone", () => {
  test("is the isotonic regression", () => {
    const random = drawn(1);
    for (let i = 0; i < 50; i++) {
      const y = randomRow(random, 1 + Math.floor(random() * 12));
      expectNear(monotone(y), slowIsotonic(y), 1e-12);
    }
  });

  test("falling is the mirror of rising", () => {
    const y = [3, 1, 4, 1, 5, 9, 2, 6];
    expectNear(
      monotone(y, new Set(), "falling"),
      monotone(y.map((v) => -v)).map((v) => -v),
      0,
    );
  });

  test("leaves held points where they are and is nearest among all that do", () => {
    const random = drawn(2);
    for (let i = 0; i < 40; i++) {
      const y = randomRow(random, 9);
      const [a, b] = [2, 6];
      if (y[a]! > y[b]!) continue;
      const made = monotone(y, new Set([a, b]));
      expect([made[a], made[b]]).toEqual([y[a], y[b]]);
      expect(rises(made)).toBe(true);
      for (let tries = 0; tries < 30; tries++) {
        const other = slowIsotonic(Array.from(made, (v) => v + (random() - 0.5) * 4));
        other[a] = y[a]!;
        other[b] = y[b]!;
        if (rises(other)) expect(squares(other, y)).toBeGreaterThanOrEqual(squares(made, y) - 1e-9);
      }
    }
  });

  test("held points that contradict each other compromise half-way", () => {
    expect([...monotone([0, 10, 5, 2], new Set([1, 3]))]).toEqual([0, 6, 6, 6]);
  });
});

describe("integral", () => {
  test("is linear in the control points and that of the curve, end values included", () => {
    const x = linspace(-1, 5, 60_001);
    for (const curve of splines) {
      expectNear([integral_cN_mm(curve, -1, 5)], [trapezoid(x, force_cN(curve, x))], 1e-6);
      const weights = integralWeights(curve, -1, 5);
      expectNear([dot(weights, curve.control_points_cN)], [integral_cN_mm(curve, -1, 5)], 1e-12);
      expectNear([weights.reduce((s, w) => s + w, 0)], [6], 1e-12);
    }
  });

  test("adds up over parts", () => {
    for (const curve of splines) {
      const parts = integral_cN_mm(curve, 0.3, 1.9) + integral_cN_mm(curve, 1.9, 4.2);
      expectNear([integral_cN_mm(curve, 0.3, 4.2)], [parts], 1e-12);
    }
  });
});

describe("keepWork", () => {
  test("keeps the sum, holds what is held and changes least", () => {
    const weights = integralWeights(clear, 0, 4);
    const c = Float64Array.from(clear.control_points_cN);
    const wanted = dot(weights, c);
    c[3] = c[3]! + 12;
    const made = keepWork(c, { weights, wanted }, new Set([3]));
    expectNear([dot(weights, made)], [wanted], 1e-12);
    expect(made[3]).toBe(c[3]);
    // the least change is along the weights
    const ratios = [...made].flatMap((v, i) => (i === 3 ? [] : [(v - c[i]!) / weights[i]!]));
    expectNear(
      ratios,
      ratios.map(() => ratios[0]!),
      1e-9,
    );
  });
});

describe("constrain", () => {
  const weights = integralWeights(clear, 0, 4);
  const before = clear.control_points_cN;
  const work = { weights, wanted: dot(weights, before) };
  const lifted = before.map((v, i) => (i === 5 ? v + 10.26 : v));

  test("without constraints gives what is asked for", () => {
    expect([...constrain(before, lifted, new Set([5]), {})]).toEqual(lifted);
  });

  test("snaps and limits what is held, and limits the rest", () => {
    const made = constrain(before, lifted, new Set([5]), { step_cN: 0.5, least_cN: 20, most_cN: 70 });
    expect(made[5]).toBe(70);
    expect(constrain(before, lifted, new Set([5]), { step_cN: 0.5 })[5]).toBe(76.5);
    expect(Math.min(...made)).toBe(20);
    expect(Math.max(...made)).toBe(70);
  });

  test("keeps the forces at the ends, whatever is asked", () => {
    const asked = before.map((v) => v + 5);
    const made = constrain(before, asked, new Set(before.keys()), { keepEnds: true });
    expect([made[0], made[14], made[7]]).toEqual([before[0], before[14], before[7]! + 5]);
  });

  test("keeps work, monotony, ends and limits at once", () => {
    const random = drawn(3);
    for (let i = 0; i < 60; i++) {
      const start = monotone(randomRow(random, 15));
      const asked = Float64Array.from(start);
      const index = 1 + Math.floor(random() * 13);
      asked[index] = Math.min(asked[14]!, Math.max(asked[0]!, asked[index]! + (random() - 0.5) * 10));
      const goal = { weights, wanted: dot(weights, start) };
      const rules = { monotone: "rising", keepWork: true, keepEnds: true, most_cN: 50 } as const;
      const made = constrain(start, asked, new Set([index]), rules, goal);
      expect(rises(made)).toBe(true);
      expect([made[0], made[index], made[14]]).toEqual([start[0], asked[index], start[14]]);
      const free = { ...rules, keepWork: false };
      const reach = [start[0]!, start[14]!].map((value) => {
        const row = asked.map((v, j) => (j === 0 || j === 14 || j === index ? v : value));
        return dot(weights, constrain(start, row, new Set([index]), free));
      });
      const wanted = Math.min(Math.max(goal.wanted, reach[0]!), reach[1]!);
      expectNear([dot(weights, made)], [wanted], 1e-9);
    }
  });

  test("with work kept nothing nearer to what was asked keeps it too", () => {
    const made = constrain(before, lifted, new Set([5]), { keepWork: true, least_cN: 30 }, work);
    const random = drawn(4);
    const least = squares(made, lifted);
    for (let i = 0; i < 300; i++) {
      const other = keepWork(
        made.map((v) => v + (random() - 0.5)),
        work,
        new Set([5]),
      );
      other[5] = made[5]!;
      const rest = work.wanted - dot(weights, other);
      if (Math.min(...other) < 30 || Math.abs(rest) > 1e-6) continue;
      expect(squares(other, lifted)).toBeGreaterThanOrEqual(least - 1e-6);
    }
  });

  test("comes as near to the work as limits let it", () => {
    const made = constrain(before, lifted, new Set([5]), { keepWork: true, most_cN: 20 }, work);
    expect([...made]).toEqual(before.map(() => 20));
  });
});
