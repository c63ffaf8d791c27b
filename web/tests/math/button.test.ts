import { describe, expect, test } from "vitest";
import {
  acceleration_m_s2,
  blendOf,
  buttonDifference,
  type Difference,
  decayTime_s,
  type Interpolation,
  type Landmarks,
  landmarks,
  linspace,
  nearest,
  peak_m_s2,
  type Stroke,
  snap,
  surface,
  surfaceGrid,
  vibrationSamples,
  work_mJ,
} from "../../src/math";
import { builtIn, example, golden } from "../golden/golden";
import { expectNear } from "./near";

interface Case {
  readonly model: string;
  readonly built_in: boolean;
  readonly x_mm: number[];
  readonly fields: {
    readonly stroke: Stroke;
    readonly interpolation: Interpolation;
    readonly velocity_mm_s: number;
    readonly force_cN: number[];
    readonly stiffness_cN_mm: number[];
    readonly damping_cN_s_mm: number[];
  }[];
  readonly landmarks: [number | null, Landmarks][];
  readonly vibrations: number[][];
}

/** Places and counts that both sides must find at the same sample. */
const PLACES: readonly (keyof Landmarks)[] = ["peak_mm", "valley_mm", "contact_mm"];
const EXACT = [...PLACES, "velocity_mm_s", "actuation_mm", "reset_mm"];

describe.each(golden<Case>("buttons").map((one) => [one.model, one] as const))("%s", (name, one) => {
  const model = one.built_in ? builtIn(name) : example(name);

  test("has Python's force, stiffness and damping between its velocities", () => {
    for (const field of one.fields) {
      const button = { ...model, interpolation: field.interpolation };
      const force = blendOf(button, field.stroke, one.x_mm);
      expectNear(force.at(field.velocity_mm_s), field.force_cN);
      expectNear(force.slopeAt(field.velocity_mm_s), field.damping_cN_s_mm);
      expectNear(blendOf(button, field.stroke, one.x_mm, 1).at(field.velocity_mm_s), field.stiffness_cN_mm);
    }
  });

  test("has Python's landmarks", () => {
    for (const [velocity_mm_s, wanted] of one.landmarks) {
      const got = landmarks(model, velocity_mm_s);
      expect(Object.keys(got).sort()).toEqual(Object.keys(wanted).sort());
      for (const key of Object.keys(wanted) as (keyof Landmarks)[]) {
        if (wanted[key] === null || EXACT.includes(key)) expect(got[key], key).toBe(wanted[key]);
        else expectNear([got[key]!], [wanted[key]]);
      }
    }
  });

  test("vibrates as in Python", () => {
    one.vibrations.forEach((wanted, i) => {
      const got = vibrationSamples(model.vibrations[i]!, 8000, 0.001).filter((_, j) => j % 4 === 0);
      expectNear(got.subarray(0, wanted.length), wanted);
    });
  });
});

test("differences are those of fdvv compare", () => {
  type Row = Difference & { names: [string, string]; stroke: Stroke; velocity_mm_s: number | null };
  for (const row of golden<Row>("differences")) {
    const got = buttonDifference(
      builtIn(row.names[0]),
      builtIn(row.names[1]),
      row.stroke,
      row.velocity_mm_s,
    )!;
    for (const key of ["rms_cN", "mean_cN", "max_cN"] as const) expectNear([got[key]], [row[key]]);
    for (const key of ["max_mm", "from_mm", "to_mm"] as const) expect(got[key]).toBe(row[key]);
  }
});

test("a surface has a row for each velocity, each the blend there", () => {
  const model = builtIn("mx-clear");
  const [v, x] = surfaceGrid(model, "press", 21, 81);
  const made = surface(model, "press", v, x);
  expect([v[0], v[20], x[0], x[80]]).toEqual([0.5, 200, 0, 4]);
  for (const row of [0, 7, 20]) {
    const wanted = blendOf(model, "press", x).at(v[row]!);
    expect([...made.force_cN.subarray(row * 81, (row + 1) * 81)]).toEqual([...wanted]);
  }
});

test("at a measured velocity the blend is that curve, to the bit", () => {
  const model = builtIn("mx-clear");
  const x = linspace(0, 4, 41);
  for (const curve of model.curves.filter((c) => c.stroke === "release")) {
    expect(nearest(model, "release", curve.velocity_mm_s)).toBe(curve);
    const own = blendOf({ ...model, curves: [curve] }, "release", x).at(1);
    expect([...blendOf(model, "release", x).at(curve.velocity_mm_s!)]).toEqual([...own]);
  }
});

test("the work of a stroke is the landmark's", () => {
  const model = builtIn("mx-blue");
  expect(work_mJ(nearest(model, "press")!, model.travel_mm)).toBe(landmarks(model).work_mJ);
});

test("a button without a press has no landmarks", () => {
  const model = builtIn("mx-clear");
  const curves = model.curves.filter((curve) => curve.stroke === "release");
  expect(() => landmarks({ ...model, curves })).toThrow(
    "model 'mx-clear' has no press curve to read landmarks from",
  );
});

test("a vibration is silent before its onset and after its duration, and has a peak and a decay", () => {
  const mode = { frequency_Hz: 250, amplitude_m_s2: 8, decay_1_s: 100, phase_rad: Math.PI / 2 };
  const vibration = {
    stroke: "press" as const,
    velocity_mm_s: null,
    onset_mm: 1,
    duration_s: 0.05,
    modes: [mode],
  };
  expect([...acceleration_m_s2(vibration, [-1e-9, 0.0500001])]).toEqual([0, 0]);
  expect(peak_m_s2(vibration)).toBeCloseTo(8, 12);
  expect(decayTime_s(vibration, Math.exp(-2))).toBeCloseTo(0.02, 12);
});

test.each([
  [12.34, 0.5, 12.5],
  [0.30000000000000004, 0.1, 0.3],
  [-7.4, 5, -5],
  [-0.2, 1, 0],
  [3.3, 0, 3.3],
])("%f snaps to steps of %f as %f", (value, step, wanted) => expect(snap(value, step)).toBe(wanted));
