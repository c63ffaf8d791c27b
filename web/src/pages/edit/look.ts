/** How curves look: the scale of velocity, the dash of releases, and names. */

import { type Stroke as Line, RELEASE_DASH, velocityColour } from "../../draw";
import type { CurveRef, FDVVModel } from "../../model";

/** The velocities of a model, slow before fast, unknown first. */
export function velocitiesOf(model: FDVVModel): (number | null)[] {
  const all = new Set(model.curves.map((curve) => curve.velocity_mm_s));
  return [...all].sort((a, b) => (a ?? 0) - (b ?? 0));
}

/** The line of a curve: its velocity's colour, dashed for a release. */
export function lineOf({ stroke, velocity_mm_s }: CurveRef): Line {
  return { colour: velocityColour(velocity_mm_s), dash: stroke === "release" ? RELEASE_DASH : [] };
}

/** The name in lists. */
export function longName(at: CurveRef): string {
  return at.velocity_mm_s === null ? "speed unknown" : `${at.velocity_mm_s} mm/s`;
}

/** A curve in words, as where it is chosen. */
export function wordsOf(at: CurveRef): string {
  return `${at.stroke}, ${longName(at)}`;
}

/** A key that names a curve in maps and in the address. */
export function keyOf(at: CurveRef): string {
  return `${at.stroke}@${at.velocity_mm_s ?? "unknown"}`;
}

/** The opacity of what is not being edited. */
export const DIMMED = 0.5;
