import { expect, test } from "vitest";
import { applyPatch, diff, type FDVVModel, invert, isEmpty, type Patch, same } from "../../src/model";
import { builtIn, example, golden } from "../golden/golden";
import { drawn } from "../math/near";
import { walk } from "./random";

interface Case {
  readonly before: FDVVModel;
  readonly after: FDVVModel;
  readonly patch: Patch;
  readonly fits_unknown: boolean;
}

const cases = golden<Case>("patches").map((one, i) => [i, one] as const);

test.each(cases)("patch %i is Python's and leads there and back", (_, one) => {
  expect(diff(one.before, one.after)).toEqual(one.patch);
  expect(applyPatch(one.before, one.patch)).toEqual(one.after);
  expect(applyPatch(one.after, invert(one.patch))).toEqual(one.before);
  expect(invert(invert(one.patch))).toEqual(one.patch);
  const unknown = example("unknown");
  if (one.fits_unknown) expect(() => applyPatch(unknown, one.patch)).not.toThrow();
  else expect(() => applyPatch(unknown, one.patch)).toThrow(/^the edit does not fit the model: its /);
});

test("between any two models a patch leads exactly, there and back, also as JSON", () => {
  const models = ["mx-clear", "rubber-dome"].flatMap((name, i) => walk(builtIn(name), drawn(i), 60));
  const random = drawn(9);
  for (let i = 0; i < 200; i++) {
    const [a, b] = [
      models[Math.floor(random() * models.length)]!,
      models[Math.floor(random() * models.length)]!,
    ];
    const patch = JSON.parse(JSON.stringify(diff(a, b))) as Patch;
    expect(same(applyPatch(a, patch), b)).toBe(true);
    expect(same(applyPatch(b, invert(patch)), a)).toBe(true);
    expect(isEmpty(diff(a, b))).toBe(same(a, b));
  }
});

test("moving a point is a patch of that point", () => {
  const a = example("two");
  const [first, second] = a.curves;
  const points = first!.control_points_cN.map((c, i) => (i === 1 ? c + 1 : c));
  const b = { ...a, curves: [{ ...first!, control_points_cN: points }, second!] };
  const { stroke, velocity_mm_s } = first!;
  expect(diff(a, b)).toEqual({
    curves: [{ stroke, velocity_mm_s, points: [[1, points[1]! - 1, points[1]!]] }],
  });
});
