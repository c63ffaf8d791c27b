/**
 * The smallest difference between two models: what is sent and kept; `fdvv.workflow` applies the same.
 *
 * A patch holds both sides of every change, so that it can be inverted by itself and refuses a model that it
 * was not made of.
 */

import { ModelError } from "../math";
import { canonical, curveAt, isAt, label, NO_PROVENANCE, same, vibrationAt } from "./model";
import type { CurveRef, CurveSpread, FDVVModel, ForceCurve, Mode, Vibration, VibrationSpread } from "./types";

const OWN_FIELDS = [
  "name",
  "travel_mm",
  "actuation_mm",
  "reset_mm",
  "interpolation",
  "travel_spread",
  "actuation_spread",
  "reset_spread",
] as const;
const PROVENANCE_FIELDS = ["source", "licence", "citation", "method", "assumptions", "simulated"] as const;

/** The fields that change as a whole: of the model, and of its provenance. */
export type Field = (typeof OWN_FIELDS)[number] | (typeof PROVENANCE_FIELDS)[number];

/** A curve without its stroke and velocity. */
export interface CurveShape {
  readonly degree: number;
  readonly knots_mm: readonly number[];
  readonly control_points_cN: readonly number[];
  readonly spread?: CurveSpread;
}

/** A vibration without its stroke and velocity. */
export interface VibrationShape {
  readonly onset_mm: number;
  readonly duration_s: number;
  readonly modes: readonly Mode[];
  readonly spread?: VibrationSpread;
}

/** Index of a control point, its force before and after. */
export type PointChange = readonly [number, number, number];

/** A curve that came (after), went (before), is another (both), or has control points at other forces. */
export interface CurveChange extends CurveRef {
  readonly before?: CurveShape;
  readonly after?: CurveShape;
  readonly points?: readonly PointChange[];
}

/** A vibration that came, went or is another. */
export interface VibrationChange extends CurveRef {
  readonly before?: VibrationShape;
  readonly after?: VibrationShape;
}

/** A difference between two models. */
export interface Patch {
  /** Field to its value before and after; null where it has none. */
  readonly fields?: Readonly<Partial<Record<Field, readonly [unknown, unknown]>>>;
  readonly curves?: readonly CurveChange[];
  readonly vibrations?: readonly VibrationChange[];
}

/** Whether a patch changes nothing. */
export function isEmpty(patch: Patch): boolean {
  return !patch.fields && !patch.curves && !patch.vibrations;
}

/** Find the patch that leads from one model to another. */
export function diff(a: FDVVModel, b: FDVVModel): Patch {
  const fields = { ...changed(a, b, OWN_FIELDS), ...changed(a.provenance, b.provenance, PROVENANCE_FIELDS) };
  const curves = keys(a.curves, b.curves).flatMap((at) => curveChange(at, curveAt(a, at), curveAt(b, at)));
  const vibrations = keys(a.vibrations, b.vibrations).flatMap((at) =>
    wholeChange(at, vibrationAt(a, at), vibrationAt(b, at)),
  );
  return {
    ...(Object.keys(fields).length ? { fields } : {}),
    ...(curves.length ? { curves } : {}),
    ...(vibrations.length ? { vibrations } : {}),
  };
}

function changed<Of extends object>(a: Of, b: Of, names: readonly (keyof Of)[]) {
  const differing = names.filter((name) => !same(a[name], b[name]));
  return Object.fromEntries(differing.map((name) => [name, [a[name] ?? null, b[name] ?? null] as const]));
}

function keys(a: readonly CurveRef[], b: readonly CurveRef[]): CurveRef[] {
  const all = [...a, ...b.filter((part) => !a.some((there) => isAt(there, part)))];
  return all.map(({ stroke, velocity_mm_s }) => ({ stroke, velocity_mm_s }));
}

function shapeOf<Part extends CurveRef>(part: Part): Omit<Part, "stroke" | "velocity_mm_s"> {
  const { stroke: _stroke, velocity_mm_s: _velocity, ...shape } = part;
  return shape;
}

function curveChange(at: CurveRef, a: ForceCurve | null, b: ForceCurve | null): CurveChange[] {
  if (!a || !b || a === b) return wholeChange(at, a, b);
  const alike = a.degree === b.degree && same(a.knots_mm, b.knots_mm) && same(a.spread, b.spread);
  if (!alike) return wholeChange(at, a, b);
  const points = a.control_points_cN.flatMap((c, i): PointChange[] =>
    c === b.control_points_cN[i] ? [] : [[i, c, b.control_points_cN[i]!]],
  );
  return points.length ? [{ ...at, points }] : [];
}

function wholeChange<Part extends CurveRef>(at: CurveRef, a: Part | null, b: Part | null) {
  if (same(a, b)) return [];
  return [{ ...at, ...(a ? { before: shapeOf(a) } : {}), ...(b ? { after: shapeOf(b) } : {}) }];
}

/** Return the patch that takes another one back. */
export function invert(patch: Patch): Patch {
  const { fields, curves, vibrations } = patch;
  return {
    ...(fields
      ? { fields: Object.fromEntries(Object.entries(fields).map(([name, [a, b]]) => [name, [b, a]])) }
      : {}),
    ...(curves ? { curves: curves.map(turnedCurve) } : {}),
    ...(vibrations ? { vibrations: vibrations.map(turned) } : {}),
  };
}

function turnedCurve(change: CurveChange): CurveChange {
  if (!change.points) return turned(change);
  return { ...change, points: change.points.map(([i, before, after]) => [i, after, before]) };
}

function turned<Shape>({
  before,
  after,
  ...at
}: CurveRef & { readonly before?: Shape; readonly after?: Shape }) {
  return { ...at, ...(after ? { before: after } : {}), ...(before ? { after: before } : {}) };
}

/** Apply a patch to the model it was made of. Throws ModelError on another. */
export function applyPatch(model: FDVVModel, patch: Patch): FDVVModel {
  const made = { ...model, provenance: { ...model.provenance } };
  for (const [name, [before, after]] of Object.entries(patch.fields ?? {})) {
    const holder: Record<string, unknown> = name in NO_PROVENANCE ? made.provenance : made;
    expect(holder[name] ?? null, before, name);
    holder[name] = after;
  }
  const curves = (patch.curves ?? []).reduce(changedCurve, model.curves);
  const vibrations = (patch.vibrations ?? []).reduce(changedPart<Vibration>, model.vibrations);
  return canonical({ ...made, curves, vibrations });
}

function expect(there: unknown, before: unknown, what: string): void {
  if (!same(there, before)) throw new ModelError(`the edit does not fit the model: its ${what} is another`);
}

function changedCurve(curves: readonly ForceCurve[], change: CurveChange): readonly ForceCurve[] {
  if (!change.points) return changedPart(curves, change);
  const curve = curves.find((c) => isAt(c, change));
  const points = Array.from(curve?.control_points_cN ?? []);
  for (const [i, before, after] of change.points) {
    expect(points[i], before, `control point ${i} of ${label(change)}`);
    points[i] = after;
  }
  return curves.map((c) => (c === curve ? { ...c, control_points_cN: points } : c));
}

function changedPart<Part extends CurveRef>(
  parts: readonly Part[],
  change: CurveRef & { readonly before?: object; readonly after?: object },
): readonly Part[] {
  const there = parts.find((part) => isAt(part, change));
  expect(there && shapeOf(there), change.before, label(change));
  const { stroke, velocity_mm_s, after } = change;
  const rest = parts.filter((part) => part !== there);
  return after ? [...rest, { stroke, velocity_mm_s, ...after } as unknown as Part] : rest;
}
