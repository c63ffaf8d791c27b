/** Random edits, for properties that hold of all of them. */

import { type Constraints, STROKES, type Stroke } from "../../src/math";
import * as m from "../../src/model";

/** Draw an edit of a model; it may be one that is refused. */
export function randomEdit(model: m.FDVVModel, random: () => number): m.Edit {
  const pick = <Of>(from: readonly Of[]): Of => from[Math.floor(random() * from.length)]!;
  const number = (low: number, high: number) => Math.round((low + random() * (high - low)) * 1000) / 1000;
  const curve = pick(model.curves);
  const at: m.CurveRef = { stroke: curve.stroke, velocity_mm_s: curve.velocity_mm_s };
  const to: m.CurveRef = { stroke: pick<Stroke>(STROKES), velocity_mm_s: pick([1, 20, 50, 73, null]) };
  const index = Math.floor(random() * curve.control_points_cN.length);
  const rules: Constraints = { keepWork: random() < 0.3, keepEnds: random() < 0.3, step_cN: pick([0, 0.5]) };
  const [frequency_Hz, amplitude_m_s2, decay_1_s] = [number(0, 400), number(-9, 9), number(0, 200)];
  const mode: m.Mode = { frequency_Hz, amplitude_m_s2, decay_1_s, phase_rad: 0 };
  const vibration = pick([...model.vibrations, m.newVibration(to, number(0, 4))]);
  const segment = { segment_mm: [number(0, 2), number(1, 4)] as const };
  return pick<() => m.Edit>([
    () => m.movePoints([{ ...at, indices: [index, index + 1] }], number(-9, 9), rules),
    () => m.setPoints([{ ...at, values_cN: [[index, number(-5, 90)]] }], rules),
    () => m.addPoint(at, number(-0.2, 4.2)),
    () => m.removePoint(at, index),
    () => m.setNumber(pick(["travel_mm", "actuation_mm", "reset_mm"] as const), pick([null, number(0, 5)])),
    () => m.copyCurve(at, to),
    () => m.copySegment(at, to, segment),
    () => m.removeCurve(at),
    () => m.moveCurve(at, to),
    () => m.copyStroke(pick<Stroke>(STROKES), pick<Stroke>(STROKES)),
    () => m.addVibration(m.newVibration(to, number(0, 4), [mode])),
    () => m.removeVibration(vibration),
    () => m.copyVibration(vibration, to),
    () => m.moveVibration(vibration, to),
    () => m.setOnset(vibration, number(0, 4)),
    () => m.setDuration(vibration, number(-0.01, 0.1)),
    () => m.setMode(vibration, 0, { frequency_Hz: number(-50, 500) }),
    () => m.addMode(vibration, mode),
    () => m.removeMode(vibration, 0),
    () => m.setInterpolation(pick(["nearest", "linear", "pchip"] as const)),
    () => m.renameModel(pick(["a", "b c", " "])),
    () => m.setProvenance({ citation: pick(["x", "y"]), assumptions: [pick(["p", "q"])] }),
    () => m.addNote(pick(["felt too hard", "softer"])),
  ])();
}

/** Apply random edits, those that are refused left out; tell each model that came out. */
export function walk(start: m.FDVVModel, random: () => number, count: number): m.FDVVModel[] {
  const models = [start];
  for (let i = 0; i < count; i++) {
    const now = models[models.length - 1]!;
    try {
      models.push(m.applyEdit(now, randomEdit(now, random)));
    } catch (error) {
      if ((error as Error).name !== "ModelError") throw error;
    }
  }
  return models;
}
