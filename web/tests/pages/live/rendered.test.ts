import { describe, expect, it } from "vitest";
import { emptyPicture, fold, type JobEvent } from "../../../src/pages/live/picture";
import { renderedOptions } from "../../../src/pages/live/rendered";

const intended: JobEvent = {
  type: "intended",
  velocity_mm_s: 100,
  displacement_mm: [0, 2, 4],
  press_cN: [0, 60, 80],
  release_cN: [0, 40, 60],
  noticeable_press_cN: 4,
  noticeable_release_cN: 4,
};
const press = (stage: "baseline" | "compensate" | "probe", cN: number, skipped = ""): JobEvent => ({
  type: "press",
  stage,
  velocity_mm_s: 100,
  done: 1,
  total: 1,
  skipped,
  achieved_mm_s: 100,
  told: "",
  made: 1,
  wanted: 1,
  curves: [],
  felt: { press_cN: [null, cN, cN], release_cN: [null, -cN, null] },
});
const high = (...events: JobEvent[]) => {
  const picture = [intended, ...events].reduce(fold, emptyPicture());
  return renderedOptions(() => picture, 100).whole();
};

describe("before and after over each other", () => {
  it.each(["baseline", "compensate", "probe"] as const)("shows all of a press of the stage %s", (stage) => {
    const { x, y } = high(press(stage, 300));
    expect(y.high).toBeGreaterThan(300);
    expect(y.low).toBeLessThan(-300);
    expect(x).toEqual({ low: 0, high: 4 });
  });

  it("makes no room for a press that was not used, or that held-out presses replace", () => {
    expect(high(press("baseline", 300, "too slow")).y.high).toBeLessThan(100);
    expect(high(press("compensate", 300), press("probe", 70)).y.high).toBeLessThan(100);
  });

  it("always shows the whole target", () => expect(high().y.high).toBeGreaterThan(80));
});
