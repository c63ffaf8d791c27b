import { describe, expect, it } from "vitest";
import type { LibraryButton, LibraryStroke } from "../../../src/net/messages";
import {
  lineOf,
  seen,
  slope_cN_mm,
  speeds,
  strokeAt,
  valueAt,
  work_mJ,
} from "../../../src/pages/library/curves";
import { columns } from "../../../src/pages/library/export";

const STEP_mm = 0.01;
const sampled = (
  force: (x_mm: number) => number,
  stroke = "press",
  velocity_mm_s: number | null = null,
): LibraryStroke => ({
  stroke,
  velocity_mm_s,
  start_mm: 0,
  step_mm: STEP_mm,
  force_cN: Array.from({ length: 401 }, (_, i) => force(i * STEP_mm)),
});
const button = (...strokes: LibraryStroke[]): LibraryButton => ({
  id: "own:a",
  name: "a",
  origin: "own",
  kind: "linear",
  kind_reason: "",
  collection: "",
  stated: [],
  numbers: {},
  why: [],
  cycles: null,
  used: null,
  date: null,
  source: "",
  licence: "",
  simulated: true,
  strokes,
});

describe("curves", () => {
  it("slope and work of a spring are those of the formula", () => {
    const force = Float64Array.from(sampled((x) => 30 + 5 * x).force_cN);
    for (const slope of slope_cN_mm(force, STEP_mm)) expect(slope).toBeCloseTo(5, 9);
    expect(work_mJ(force, STEP_mm).at(-1)).toBeCloseTo(0.01 * (30 * 4 + 2.5 * 16), 9);
  });

  it("the slope of the work is the force", () => {
    const stroke = sampled((x) => 40 + 10 * Math.sin(2 * x));
    const work = lineOf(stroke, "work").y;
    const back = slope_cN_mm(work, STEP_mm).map((mJ_mm) => 100 * mJ_mm);
    for (let i = 10; i < 390; i++) expect(back[i]).toBeCloseTo(stroke.force_cN[i] as number, 1);
  });

  it("values lie on the line between samples, and nowhere beyond its ends", () => {
    const line = lineOf(
      sampled((x) => x * x),
      "force",
    );
    expect(valueAt(line, 1.005)).toBeCloseTo((1 + 1.01 ** 2) / 2, 9);
    expect(valueAt(line, 4)).toBeCloseTo(16, 9);
    expect(valueAt(line, -0.01)).toBeNaN();
    expect(valueAt(line, 4.01)).toBeNaN();
  });

  it("the stroke nearest to a speed is taken, the slowest by default", () => {
    const made = button(
      ...[50, 100, 200].map((v) => sampled(() => v, "press", v)),
      sampled(() => 1, "release", 100),
    );
    expect(strokeAt(made, "press", null)?.velocity_mm_s).toBe(50);
    expect(strokeAt(made, "press", 160)?.velocity_mm_s).toBe(200);
    expect(strokeAt(made, "release", 500)?.velocity_mm_s).toBe(100);
    expect(strokeAt(button(), "press", null)).toBeNull();
    expect(speeds([made, button(sampled(() => 1))])).toEqual([50, 100, 200]);
  });

  it("a contact step does not hide the slopes that matter", () => {
    const line = lineOf(
      sampled((x) => 35 * Math.min(1, x / 0.02) + 5 * x),
      "slope",
    );
    expect(Math.max(...line.y)).toBeGreaterThan(500);
    expect(seen([line], "slope").high).toBeLessThan(500);
    expect(
      seen(
        [
          lineOf(
            sampled((x) => 35 + 5 * x),
            "force",
          ),
        ],
        "force",
      ),
    ).toEqual({ low: 0, high: expect.closeTo(58.3, 1) });
    expect(seen([], "force")).toEqual({ low: 0, high: 100 });
  });

  it("columns of a file say button, stroke, speed, unit, and that a figure is simulated", () => {
    const made = button(sampled((x) => x, "press", 50));
    const drawn = [
      {
        n: 0,
        button: made,
        stroke: "press" as const,
        velocity_mm_s: 50,
        line: lineOf(made.strokes[0] as LibraryStroke, "force"),
      },
    ];
    const [x, y] = columns(drawn, "force");
    expect(x?.[0]).toBe("a, simulated, press, 50 mm/s: displacement, mm");
    expect(y?.[0]).toBe("a, simulated, press, 50 mm/s: force, cN");
    expect(y?.[1][200]).toBe(2);
  });
});
