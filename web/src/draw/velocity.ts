/** The one colour scale of velocity: a speed looks the same on every page, faster stands out more. */

import { palette } from "./palette";

/** The fast end, mm/s: as fast as fingers press keys. Faster ones look alike. */
const FASTEST_mm_s = 500;

/** Return the colour of a velocity, mm/s; one that is not known is muted. */
export function velocityColour(velocity_mm_s: number | null): string {
  const { velocity, muted } = palette();
  return velocity_mm_s === null ? muted : between(velocity, partOf(velocity_mm_s));
}

/** Return where on the scale a velocity lies, 0 to 1. The root spreads the slow ones, which are measured most. */
export function partOf(velocity_mm_s: number): number {
  return Math.sqrt(Math.min(1, Math.max(0, velocity_mm_s / FASTEST_mm_s)));
}

/** Return the colour at a part of a row of colours, each as `#rrggbb`. */
export function between(stops: readonly string[], part: number): string {
  const at = part * (stops.length - 1);
  const first = Math.min(Math.floor(at), stops.length - 2);
  const [from, to] = [channels(stops[first]!), channels(stops[first + 1]!)];
  const mixed = from.map((channel, i) => Math.round(channel + (at - first) * (to[i]! - channel)));
  return `#${mixed.map((channel) => channel.toString(16).padStart(2, "0")).join("")}`;
}

function channels(colour: string): number[] {
  return [1, 3, 5].map((at) => Number.parseInt(colour.slice(at, at + 2), 16));
}
