/** How curves look: a colour for each velocity, dashes for the release, and a short name beside the line. */

import { type Stroke as Line, series } from "../../draw";
import type { CurveRef, FDVVModel } from "../../model";

const RELEASE_DASH = [6, 4] as const;

/** The velocities of a model, slow before fast, unknown first; their order gives the colours. */
export function velocitiesOf(model: FDVVModel): (number | null)[] {
  const all = new Set(model.curves.map((curve) => curve.velocity_mm_s));
  return [...all].sort((a, b) => (a ?? 0) - (b ?? 0));
}

/** The line of a curve: its velocity's colour, dashed for a release. */
export function lineOf(velocities: readonly (number | null)[], at: CurveRef): Line {
  const { colour } = series(Math.max(0, velocities.indexOf(at.velocity_mm_s)));
  return { colour, dash: at.stroke === "release" ? RELEASE_DASH : [] };
}

/** The name shown beside a line. */
export function shortName(at: CurveRef): string {
  const speed = at.velocity_mm_s === null ? "?" : String(at.velocity_mm_s);
  return `${at.stroke === "press" ? "↓" : "↑"} ${speed}`;
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
