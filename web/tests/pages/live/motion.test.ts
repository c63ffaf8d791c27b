import { describe, expect, it } from "vitest";
import { countIn, depthAt, timeText } from "../../../src/pages/live/motion";

/** Of fdvv.cli's cue at the same times: the page leads as the terminal does. */
const TIMES_s = [0, 0.01, 0.02, 0.03, 0.04, 0.06, 0.09, 0.1, 0.11, 0.13];
const DEPTHS = [0, 0.103516, 0.5, 0.896484, 1, 1, 1, 0.896484, 0.5, 0];

describe("the cue", () => {
  it("moves as it does on the terminal", () => {
    TIMES_s.forEach((t_s, i) => expect(depthAt(t_s, 0.04)).toBeCloseTo(DEPTHS[i] as number, 6));
  });

  it("counts three, two, one until contact", () => {
    expect([0, 0.49, 0.51, 0.99, 1.01, 1.49, 1.5].map((t_s) => countIn(t_s, 1.5))).toEqual([
      "3",
      "3",
      "2",
      "2",
      "1",
      "1",
      "",
    ]);
  });

  it("says times as people do", () => {
    expect([timeText(0.04), timeText(8)]).toEqual(["40 ms", "8.0 s"]);
  });
});
