import { describe, expect, it } from "vitest";
import { curveKey, emptyPicture, fold, type JobEvent } from "../../../src/pages/live/picture";

const curve = (error_cN: number[]) =>
  ({ stroke: "press", velocity_mm_s: 100, error_cN, mean_error_cN: 1, max_error_cN: 2 }) as const;
const press = (error_cN: number[], skipped = ""): JobEvent => ({
  type: "press",
  stage: "compensate",
  velocity_mm_s: 100,
  done: error_cN.length,
  total: 3,
  skipped,
  achieved_mm_s: 98,
  told: "",
  made: error_cN.length,
  wanted: 3,
  curves: [curve(error_cN)],
  felt: null,
});
const question: JobEvent = {
  type: "asked",
  number: 1,
  total: 4,
  velocity_mm_s: 100,
  waves: [],
  measured: { rate_Hz: 8000, acceleration_m_s2: [] },
};
const ended: JobEvent = { type: "ended", state: "cancelled", line: "stopped" };

const folded = (events: readonly JobEvent[]) => events.reduce(fold, emptyPicture());

describe("the picture of a job", () => {
  it("keeps the newest standing of each curve and numbers the presses", () => {
    const picture = folded([press([9]), press([9], "too slow"), press([9, 5])]);
    expect(picture.curves.get(curveKey("compensate", "press", 100))?.error_cN).toEqual([9, 5]);
    expect(picture.presses.map((press) => [press.number, press.press.skipped])).toEqual([
      [1, ""],
      [2, "too slow"],
      [3, ""],
    ]);
  });

  it("is the same whether events come at once or after a reload", () => {
    const events = [press([9]), press([9, 5]), question, ended];
    const picture = folded(events.slice(0, 2));
    expect(events.slice(2).reduce(fold, picture)).toEqual(folded(events));
  });

  it("waits for nobody once the work is over, or the answer is there", () => {
    expect(folded([question]).question).not.toBeNull();
    expect(folded([question, ended]).question).toBeNull();
    const answered: JobEvent = {
      type: "answered",
      number: 1,
      total: 4,
      velocity_mm_s: 100,
      answer: "first",
      rankings: [],
    };
    expect(folded([question, answered]).question).toBeNull();
  });

  it("keeps one outcome of each part", () => {
    const outcome = (sentence: string): JobEvent => ({
      type: "outcome",
      stage: "probe",
      sentence,
      presses: 1,
      skipped: 0,
      simulated: true,
    });
    expect(folded([outcome("a"), outcome("b")]).outcomes.map((outcome) => outcome.sentence)).toEqual(["b"]);
  });
});
