import { expect, test } from "vitest";
import { spans } from "../../../src/pages/live/spans";

test("places that most presses would notice become spans, half a step wider at both ends", () => {
  const at_mm = [0.3, 0.35, 0.4, 0.45, 0.5];
  const found = spans(at_mm, [1, 0.6, 0.5, 0, 1]);
  expect(found.length).toBe(2);
  expect(found[0]?.[0]).toBeCloseTo(0.275);
  expect(found[0]?.[1]).toBeCloseTo(0.375);
  expect(found[1]?.[0]).toBeCloseTo(0.475);
  expect(found[1]?.[1]).toBeCloseTo(0.525);
});

test("nothing noticed gives no span", () => {
  expect(spans([0.3, 0.35], [0, 0.5])).toEqual([]);
});
