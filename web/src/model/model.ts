/** Models in their one order, equality, and finding the parts of one. */

import { ModelError, type Stroke, speed } from "../math";
import type { CurveRef, FDVVModel, ForceCurve, Provenance, Vibration } from "./types";

/** Of a model that does not say where it comes from. */
export const NO_PROVENANCE: Provenance = {
  source: "",
  licence: "",
  citation: "",
  method: "",
  assumptions: [],
  simulated: false,
};

/** A model as a file may write it: what has a default may be absent. */
export type FileModel = Omit<FDVVModel, "vibrations" | "provenance" | "version"> & {
  readonly version: number;
  readonly vibrations?: readonly Vibration[];
  readonly provenance?: Partial<Provenance>;
};

/** The points whose place may be known with a spread. */
const POINT_SPREADS = ["travel_spread", "actuation_spread", "reset_spread"] as const;

/**
 * Return a model in its one form: curves and vibrations in reading order (presses first, slow before fast),
 * defaults filled in, no field for a spread that is not known, the oldest version that holds it.
 */
export function canonical(model: FileModel): FDVVModel {
  const made = {
    ...model,
    curves: [...model.curves].sort(readingOrder).map(withoutEmptySpread),
    vibrations: [...(model.vibrations ?? [])].sort(readingOrder).map(canonicalVibration),
    provenance: { ...NO_PROVENANCE, ...model.provenance },
  };
  const bare = dropAbsent(made, POINT_SPREADS);
  return { ...bare, format: "fdvv-model", version: hasSpreads(bare) ? 2 : 1 };
}

function canonicalVibration(vibration: Vibration): Vibration {
  const complete = vibration.modes.every((mode) => mode.phase_rad !== undefined);
  const modes = () => vibration.modes.map((mode) => ({ ...mode, phase_rad: mode.phase_rad ?? 0 }));
  return withoutEmptySpread(complete ? vibration : { ...vibration, modes: modes() });
}

function withoutEmptySpread<Part extends { readonly spread?: unknown }>(part: Part): Part {
  return "spread" in part ? dropAbsent(part, ["spread"]) : part;
}

function dropAbsent<Of extends object>(from: Of, names: readonly (keyof Of)[]): Of {
  if (names.every((name) => !(name in from) || from[name] != null)) return from;
  const kept = { ...from };
  for (const name of names) if (kept[name] == null) delete kept[name];
  return kept;
}

function hasSpreads(
  model: Pick<FDVVModel, "curves" | "vibrations" | (typeof POINT_SPREADS)[number]>,
): boolean {
  return (
    POINT_SPREADS.some((name) => model[name]) || [...model.curves, ...model.vibrations].some((p) => p.spread)
  );
}

function readingOrder(a: CurveRef, b: CurveRef): number {
  return (
    Number(a.stroke !== "press") - Number(b.stroke !== "press") ||
    (a.velocity_mm_s ?? 0) - (b.velocity_mm_s ?? 0)
  );
}

/** Whether two values hold the same numbers, texts and fields; an absent field counts as null. */
export function same(a: unknown, b: unknown): boolean {
  if (a === b || (a == null && b == null)) return true;
  if (typeof a !== "object" || typeof b !== "object" || a === null || b === null) return false;
  if (Array.isArray(a) || Array.isArray(b)) {
    return Array.isArray(a) && Array.isArray(b) && a.length === b.length && a.every((x, i) => same(x, b[i]));
  }
  const [one, other] = [a as Record<string, unknown>, b as Record<string, unknown>];
  return [...new Set([...Object.keys(one), ...Object.keys(other)])].every((key) =>
    same(one[key], other[key]),
  );
}

/** Whether a part is the one of that stroke and velocity. */
export function isAt(part: CurveRef, at: CurveRef): boolean {
  return part.stroke === at.stroke && part.velocity_mm_s === at.velocity_mm_s;
}

/** Name a part for a person. */
export function label(part: CurveRef): string {
  return `${part.stroke} at ${speed(part.velocity_mm_s)}`;
}

/** Find a curve; null if it is not there. */
export function curveAt(model: FDVVModel, at: CurveRef): ForceCurve | null {
  return model.curves.find((curve) => isAt(curve, at)) ?? null;
}

/** Find a vibration; null if it is not there. */
export function vibrationAt(model: FDVVModel, at: CurveRef): Vibration | null {
  return model.vibrations.find((vibration) => isAt(vibration, at)) ?? null;
}

/** Find a curve, or refuse with the list of those there are. */
export function foundCurve(model: FDVVModel, at: CurveRef): ForceCurve {
  return curveAt(model, at) ?? refuse(model, "curve", at, model.curves);
}

/** Find a vibration, or refuse with the list of those there are. */
export function foundVibration(model: FDVVModel, at: CurveRef): Vibration {
  return vibrationAt(model, at) ?? refuse(model, "vibration", at, model.vibrations);
}

function refuse(model: FDVVModel, what: string, at: CurveRef, there: readonly CurveRef[]): never {
  const list = there.map(label).join(", ") || "none";
  throw new ModelError(
    `'${model.name}' has no ${at.stroke} ${what} at ${speed(at.velocity_mm_s)}; it has ${list}`,
  );
}

/** Copy a model with one part put at its stroke and velocity, replacing what is there. */
export function withCurve(model: FDVVModel, curve: ForceCurve): FDVVModel {
  return { ...model, curves: [...model.curves.filter((c) => !isAt(c, curve)), curve] };
}

/** Copy a model with a vibration put at its stroke and velocity, replacing what is there. */
export function withVibration(model: FDVVModel, vibration: Vibration): FDVVModel {
  return { ...model, vibrations: [...model.vibrations.filter((v) => !isAt(v, vibration)), vibration] };
}

/** Return the known velocities of one stroke, rising. */
export function velocities_mm_s(model: FDVVModel, stroke: Stroke): number[] {
  const known = model.curves.flatMap((c) =>
    c.stroke === stroke && c.velocity_mm_s !== null ? [c.velocity_mm_s] : [],
  );
  return known.sort((a, b) => a - b);
}
