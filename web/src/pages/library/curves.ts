/** What the overlay draws: strokes at a speed, their slope and their work. */

import type { LibraryButton, LibraryStroke } from "../../net/messages";
import type { ViewName } from "./state";

export interface Line {
  readonly x_mm: Float64Array;
  readonly y: Float64Array;
}

export type StrokeName = "press" | "release";

/** Slopes are of means over this width, the one over which a bump is defined. */
const SLOPE_mm = 0.05;

/** Return the stroke that was measured nearest to a speed, the slowest for null. */
export function strokeAt(
  button: LibraryButton,
  stroke: StrokeName,
  velocity_mm_s: number | null,
): LibraryStroke | null {
  const wanted = velocity_mm_s ?? 0;
  const off = (one: LibraryStroke) => Math.abs((one.velocity_mm_s ?? 0) - wanted);
  const found = button.strokes.filter((one) => one.stroke === stroke);
  return found.reduce<LibraryStroke | null>(
    (best, one) => (best === null || off(one) < off(best) ? one : best),
    null,
  );
}

/** Return every speed that a button was measured at, rising. */
export function speeds(buttons: readonly LibraryButton[]): number[] {
  const all = buttons.flatMap((button) => button.strokes.map((stroke) => stroke.velocity_mm_s));
  return [...new Set(all.filter((v) => v !== null))].sort((a, b) => a - b);
}

export function lineOf(stroke: LibraryStroke, view: ViewName): Line {
  const force_cN = Float64Array.from(stroke.force_cN);
  const x_mm = Float64Array.from(force_cN, (_, i) => stroke.start_mm + i * stroke.step_mm);
  if (view === "force") return { x_mm, y: force_cN };
  return {
    x_mm,
    y: view === "slope" ? slope_cN_mm(force_cN, stroke.step_mm) : work_mJ(force_cN, stroke.step_mm),
  };
}

/** Differentiate over 50 µm around every point, over what there is at the ends. */
export function slope_cN_mm(force_cN: Float64Array, step_mm: number): Float64Array {
  const reach = Math.max(1, Math.round(SLOPE_mm / step_mm / 2));
  const last = force_cN.length - 1;
  return force_cN.map((_, i) => {
    const [from, to] = [Math.max(0, i - reach), Math.min(last, i + reach)];
    return ((force_cN[to] as number) - (force_cN[from] as number)) / ((to - from) * step_mm);
  });
}

/** Integrate from contact; 1 cN mm is 0.01 mJ. */
export function work_mJ(force_cN: Float64Array, step_mm: number): Float64Array {
  const work = new Float64Array(force_cN.length);
  for (let i = 1; i < work.length; i++) {
    const mean_cN = ((force_cN[i] as number) + (force_cN[i - 1] as number)) / 2;
    work[i] = (work[i - 1] as number) + 0.01 * mean_cN * step_mm;
  }
  return work;
}

/** Read a line at a place; NaN beyond its ends. */
export function valueAt(line: Line, x_mm: number): number {
  const [first, last] = [line.x_mm[0] as number, line.x_mm.at(-1) as number];
  if (!(x_mm >= first && x_mm <= last)) return NaN;
  const place = ((x_mm - first) / (last - first)) * (line.x_mm.length - 1);
  const before = Math.min(Math.floor(place), line.x_mm.length - 2);
  const [low, high] = [line.y[before] as number, line.y[before + 1] as number];
  return low + (place - before) * (high - low);
}

/** Return the range that shows lines well, with zero: of slopes all but the steepest 2 % up and 0.5 % down. */
export function seen(lines: readonly Line[], view: ViewName): { low: number; high: number } {
  const all = lines
    .flatMap((line) => [...line.y])
    .filter(Number.isFinite)
    .sort((a, b) => a - b);
  if (!all.length) return { low: 0, high: view === "work" ? 2 : 100 };
  const [below, above] = view === "slope" ? [0.005, 0.02] : [0, 0];
  const low = Math.min(0, all[Math.floor(below * (all.length - 1))] as number);
  const high = Math.max(0, all[Math.ceil((1 - above) * (all.length - 1))] as number);
  const air = 0.06 * (high - low || 1);
  return { low: low < 0 ? low - air : 0, high: high + air };
}
