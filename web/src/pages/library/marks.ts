/** How the compared buttons look: a colour each; more than twelve are dimmed, of more than six those not looked at. */

import { palette, type Stroke } from "../../draw";

export const DISTINCT = 12;
/** More than these on the same axes are a crowd: all but the ones pointed at fade. */
const CROWD = 6;
const FADED = 0.22;

/** Return the stroke of the n-th button of the overlay. */
export function strokeOf(n: number): Stroke {
  const { series, muted } = palette();
  if (n >= DISTINCT) return { colour: muted, opacity: 0.45, width_px: 1 };
  return { colour: series[n % series.length] as string, width_px: 2 };
}

/** Return the opacity of a button among `count`. */
export function fade(count: number, looked_at: boolean): number {
  return count > CROWD && !looked_at ? FADED : 1;
}
