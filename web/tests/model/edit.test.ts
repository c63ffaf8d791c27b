import { describe, expect, test } from "vitest";
import { curvesOf, force_cN, integral_cN_mm, linspace, ModelError } from "../../src/math";
import * as m from "../../src/model";
import { builtIn, example, golden } from "../golden/golden";
import { drawn, expectNear } from "../math/near";
import { walk } from "./random";

interface Case {
  readonly op: "assign" | "copy" | "remove" | "merge";
  readonly on: string;
  readonly made: m.FDVVModel | null;
  readonly curve: m.ForceCurve;
  readonly to: m.CurveRef;
  readonly from: m.CurveRef;
  readonly at: m.CurveRef;
  readonly segment_mm?: [number, number];
  readonly blend_mm?: number;
  readonly others: string[];
  readonly options: m.MergeOptions;
}

function editOf(one: Case): m.Edit {
  const segment = one.segment_mm && { segment_mm: one.segment_mm, blend_mm: one.blend_mm ?? 0.1 };
  if (one.op === "assign") return m.assignCurve(one.curve, one.to, segment);
  if (one.op === "copy") return m.copyCurve(one.from, one.to);
  if (one.op === "remove") return m.removeCurve(one.at);
  return m.mergeModels(one.others.map(example), one.options);
}

/** Compare models: texts exactly, numbers within rounding. */
function expectModel(got: unknown, wanted: unknown, place = "$"): void {
  if (typeof wanted === "number") expectNear([got as number], [wanted]);
  else if (wanted && typeof wanted === "object") {
    expect(Object.keys(got as object).sort(), place).toEqual(Object.keys(wanted).sort());
    for (const [key, value] of Object.entries(wanted)) {
      expectModel((got as Record<string, unknown>)[key], value, `${place}.${key}`);
    }
  } else expect(got, place).toBe(wanted);
}

const cases = golden<Case>("edits").map((one, i) => [i, one.op, one] as const);

test.each(cases)("edit %i, %s, is Python's", (_, __, one) => {
  const work = () => m.applyEdit(example(one.on), editOf(one));
  if (one.made) expectModel(work(), one.made);
  else expect(work).toThrow(ModelError);
});

const clear = builtIn("mx-clear");
const slow: m.CurveRef = { stroke: "press", velocity_mm_s: 0.5 };
const fast: m.CurveRef = { stroke: "press", velocity_mm_s: 200 };
const at = (model: m.FDVVModel, ref: m.CurveRef) => m.curveAt(model, ref)!;

describe("control points", () => {
  test("move together in several curves, the rest stays", () => {
    const made = m.applyEdit(
      clear,
      m.movePoints(
        [
          { ...slow, indices: [2, 3] },
          { ...fast, indices: [4] },
        ],
        -2.5,
      ),
    );
    expect(at(made, slow).control_points_cN[2]).toBe(at(clear, slow).control_points_cN[2]! - 2.5);
    expect(at(made, fast).control_points_cN[4]).toBe(at(clear, fast).control_points_cN[4]! - 2.5);
    expect(at(made, slow).control_points_cN[4]).toBe(at(clear, slow).control_points_cN[4]);
    const untouched = made.curves.filter((c) => !m.isAt(c, slow) && !m.isAt(c, fast));
    expect(untouched.every((c) => clear.curves.includes(c))).toBe(true);
  });

  test("move with the work of the stroke kept", () => {
    const made = m.applyEdit(clear, m.movePoints([{ ...slow, indices: [6] }], 9, { keepWork: true }));
    expectNear([integral_cN_mm(at(made, slow), 0, 4)], [integral_cN_mm(at(clear, slow), 0, 4)], 1e-12);
    expect(at(made, slow).control_points_cN[6]).toBe(at(clear, slow).control_points_cN[6]! + 9);
  });

  test("take exact values, and the label says them", () => {
    const edit = m.setPoints([{ ...slow, values_cN: [[3, 41.5]] }]);
    expect(edit.label).toBe("set a point to 41.5 cN of press at 0.5 mm/s");
    expect(at(m.applyEdit(clear, edit), slow).control_points_cN[3]).toBe(41.5);
  });

  test("come and go with the shape kept, as far as said", () => {
    const more = m.applyEdit(clear, m.addPoint(slow, 0.3));
    const x = linspace(0, 4, 200);
    expectNear(force_cN(at(more, slow), x), force_cN(at(clear, slow), x));
    const back = m.applyEdit(more, m.removePoint(slow, 3));
    expect(at(back, slow).control_points_cN).toHaveLength(15);
  });

  test("a drawn curve has no spread, and the provenance tells of it once", () => {
    const spreads = example("spreads");
    const ref = { stroke: "press", velocity_mm_s: 10 } as const;
    const once = m.applyEdit(spreads, m.movePoints([{ ...ref, indices: [0] }], 1));
    const twice = m.applyEdit(once, m.movePoints([{ ...ref, indices: [1] }], 1));
    expect(at(twice, ref).spread).toBeUndefined();
    expect(at(twice, { ...ref, velocity_mm_s: 80 }).spread).toBeDefined();
    expect(twice.provenance.method).toBe("press at 10 mm/s drawn");
    expect(twice.version).toBe(2);
  });
});

describe("facts", () => {
  test("a point that is set loses its spread, another keeps it", () => {
    const spreads = example("spreads");
    expect(m.applyEdit(spreads, m.setNumber("actuation_mm", 1.5)).actuation_spread).toBeUndefined();
    const other = m.applyEdit(spreads, m.setNumber("reset_mm", 1.5));
    expect(other.actuation_spread).toEqual({ spread_mm: 0.02, presses: 9 });
    expect(m.applyEdit(spreads, m.setNumber("actuation_mm", 1.7)).actuation_spread).toBeDefined();
  });

  test("forgetting a point makes it unknown", () => {
    expect(m.applyEdit(clear, m.setNumber("reset_mm", null)).reset_mm).toBeNull();
  });
});

test.each<[string, m.Edit]>([
  ["actuation_mm must lie within the travel of 4 mm, got 4.5", m.setNumber("actuation_mm", 4.5)],
  ["actuation_mm must lie within the travel of 1.5 mm, got 2", m.setNumber("travel_mm", 1.5)],
  ["travel_mm must be positive and finite, got 0", m.setNumber("travel_mm", 0)],
  ["travel_mm must be positive and finite, got NaN", m.setNumber("travel_mm", Number.NaN)],
  ["name must be text without spaces at its ends, got ''", m.renameModel("  ")],
  [
    "control_points_cN must be finite, got Infinity at index 3",
    m.setPoints([{ ...slow, values_cN: [[3, Infinity]] }]),
  ],
  [
    "control_points_cN must stay within 1000000, got 2000000",
    m.setPoints([{ ...slow, values_cN: [[3, 2e6]] }]),
  ],
  [
    "press curve of unknown velocity must stand alone, got [unknown, 50, 100, 150, 200] mm/s",
    m.setVelocity(slow, null),
  ],
  ["there is a press curve at 50 mm/s already; remove it first", m.setVelocity(slow, 50)],
  ["velocity_mm_s must be positive and finite, got -3", m.setVelocity(slow, -3)],
  ["a vibration needs at least one mode", m.removeMode({ stroke: "press", velocity_mm_s: null }, 0)],
  [
    "duration_s must be positive and finite, got 0",
    m.setDuration({ stroke: "press", velocity_mm_s: null }, 0),
  ],
  [
    "'mx-clear' has no press vibration at 50 mm/s; it has press at unknown velocity, release at unknown velocity",
    m.removeVibration({ stroke: "press", velocity_mm_s: 50 }),
  ],
])("refused: %s", (line, edit) => {
  const before = JSON.stringify(clear);
  expect(() => m.applyEdit(clear, edit)).toThrow(line);
  expect(JSON.stringify(clear)).toBe(before);
});

describe("vibrations", () => {
  const all = { stroke: "press", velocity_mm_s: null } as const;

  test("are edited number by number", () => {
    const edits = [m.setOnset(all, 1.9), m.setMode(all, 0, { decay_1_s: 80 }), m.addMode(all)];
    const made = m.applyEdit(clear, m.together("tune", edits));
    const vibration = m.vibrationAt(made, all)!;
    expect([vibration.onset_mm, vibration.modes[0]!.decay_1_s, vibration.modes.length]).toEqual([1.9, 80, 2]);
  });

  test("are copied to another stroke", () => {
    const bare = m.applyEdit(clear, m.removeVibration({ stroke: "release", velocity_mm_s: null }));
    const to = { stroke: "release", velocity_mm_s: 50 } as const;
    const made = m.applyEdit(bare, m.copyVibration(all, to));
    expect(m.vibrationAt(made, to)!.modes).toEqual(m.vibrationAt(clear, all)!.modes);
  });
});

test("copying a stroke replaces the other one", () => {
  const made = m.applyEdit(clear, m.copyStroke("press", "release"));
  const [press, release] = [curvesOf(made, "press"), curvesOf(made, "release")];
  expect(release.map((c) => c.velocity_mm_s)).toEqual(press.map((c) => c.velocity_mm_s));
  expect(release.map((c) => c.control_points_cN)).toEqual(press.map((c) => c.control_points_cN));
});

test("the models that random edits make are those that Python has accepted", async () => {
  const names = ["mixed", "two", "unknown", "spreads"];
  const made = names.flatMap((name, i) => walk(example(name), drawn(100 + i), 25).slice(-4));
  const lines = made.map((model) => JSON.stringify(model)).join(",\n");
  await expect(`[\n${lines}\n]\n`).toMatchFileSnapshot("../golden/edited.json");
});
