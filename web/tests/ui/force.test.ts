// @vitest-environment jsdom
import { beforeEach, expect, test } from "vitest";
import {
  digitsOf,
  force,
  forceUnit,
  inUnit,
  nextForceUnit,
  perUnit,
  unitText,
  withForces,
} from "../../src/ui/force";

beforeEach(() => forceUnit.set("cN"));

test("the unit turns through cN, gf and N, and is kept in the browser", () => {
  const turned = [0, 1, 2].map(() => {
    nextForceUnit();
    return [forceUnit(), localStorage.getItem("fdvv-force-unit")];
  });
  expect(turned).toEqual([
    ["gf", "gf"],
    ["N", "N"],
    ["cN", "cN"],
  ]);
});

test("1 gf is 0.980665 cN and 1 N is 100 cN, with decimals that show as much", () => {
  forceUnit.set("gf");
  expect(force(98.0665, 2)).toBe("100.00 gf");
  forceUnit.set("N");
  expect(force(64.7)).toBe("0.647 N");
  expect(inUnit(-12.3, "cN/mm", 1)).toBe("−0.123");
  expect([unitText("cN/mm"), digitsOf("cN", 1)]).toEqual(["N/mm", 3]);
});

test("what holds no force stays as it is", () => {
  forceUnit.set("gf");
  expect([perUnit("mm"), unitText("mm"), inUnit(2, "mm", 2), unitText("")]).toEqual([1, "mm", "2.00", ""]);
});

test("every force of a sentence is shown in the unit, those that share its name too", () => {
  forceUnit.set("N");
  expect(withForces("Mean error 98.1 → 4.0 cN at 50 mm/s, largest 120 cN.")).toBe(
    "Mean error 0.981 → 0.040 N at 50 mm/s, largest 1.20 N.",
  );
  expect(withForces("moved by up to 8.6 and 11 cN; gain 1.00 +- 0.02, friction −0.5 +- 1.1 cN")).toBe(
    "moved by up to 0.086 and 0.11 N; gain 1.00 +- 0.02, friction −0.005 +- 0.011 N",
  );
  forceUnit.set("cN");
  expect(withForces("8 cN")).toBe("8 cN");
});
