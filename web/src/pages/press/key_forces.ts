/** What a button would push with where a key of a keyboard is. */

import type { Sample } from "../../keyboard/depths";
import type { PressMeant } from "../../net/messages";

/** Target forces over displacement at one speed: press and release. */
export interface ForcesAtSpeed {
  readonly displacement_mm: readonly number[];
  readonly press_cN: readonly number[];
  readonly release_cN: readonly number[];
}

/** Interpolate forces, listed by rising speed, at a speed; beyond the last one they are the last one's. */
export function forcesAt(speeds: readonly PressMeant[], velocity_mm_s: number): ForcesAtSpeed | null {
  const wanted = Math.abs(velocity_mm_s);
  const above = speeds.find((one) => one.velocity_mm_s >= wanted) ?? speeds.at(-1);
  if (!above) return null;
  const below = speeds.findLast((one) => one.velocity_mm_s <= wanted) ?? above;
  const apart = above.velocity_mm_s - below.velocity_mm_s;
  const part = apart > 0 ? (wanted - below.velocity_mm_s) / apart : 0;
  const mixed = (a: readonly number[], b: readonly number[]) =>
    a.map((force, i) => force + part * ((b[i] as number) - force));
  return {
    displacement_mm: below.displacement_mm,
    press_cN: mixed(below.press_cN, above.press_cN),
    release_cN: mixed(below.release_cN, above.release_cN),
  };
}

/** Return the force at the place and in the stroke of a key; beyond the button's travel that of the stop is unknown. */
export function forceOf(forces: ForcesAtSpeed, { depth_mm, stroke }: Sample): number | null {
  const x = forces.displacement_mm;
  const end = x.at(-1) as number;
  if (depth_mm > end + 1e-6) return null;
  const y = stroke === "press" ? forces.press_cN : forces.release_cN;
  const at = (Math.min(end, Math.max(0, depth_mm)) / end) * (x.length - 1);
  const [i, rest] = [Math.floor(at), at % 1];
  return (y[i] as number) + rest * ((y[i + 1] ?? (y[i] as number)) - (y[i] as number));
}
