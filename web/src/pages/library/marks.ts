/** How the buttons of the overlay are distinguished: colour and dash; more than twelve are dimmed. */

import { palette, SERIES_DASH, type Stroke } from "../../draw";

export const DISTINCT = 12;
const DASH_step = 3;

/** Return the stroke of the n-th button of the overlay; after eight colours the dashes are others. */
export function strokeOf(n: number): Stroke {
  const { series, muted } = palette();
  if (n >= DISTINCT) return { colour: muted, opacity: 0.45, width_px: 1 };
  const round = Math.floor(n / series.length);
  const dash = SERIES_DASH[(n + DASH_step * round) % SERIES_DASH.length] as readonly number[];
  return { colour: series[n % series.length] as string, dash, width_px: 2 };
}
