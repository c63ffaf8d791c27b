/** The move that a cue shows: the same as on the terminal (minimum jerk down, a short rest, and up again). */

/** At the bottom, between down and up. */
const DWELL_s = 0.05;

/** The way covered, 0 to 1, when that part of the time has passed: the smoothest move there is. */
function minimumJerk(part: number): number {
  return part ** 3 * (10 - 15 * part + 6 * part ** 2);
}

function bounded(value: number): number {
  return Math.min(Math.max(value, 0), 1);
}

/** Depth, 0 to 1, of a press that takes stroke_s down, rests, and takes as long up. */
export function depthAt(t_s: number, stroke_s: number): number {
  const down = bounded(t_s / stroke_s);
  const up = bounded((t_s - stroke_s - DWELL_s) / stroke_s);
  return minimumJerk(down) - minimumJerk(up);
}

/** What is counted before contact: 3, 2, 1; empty from contact on. */
export function countIn(t_s: number, contact_s: number): string {
  if (t_s >= contact_s) return "";
  return String(Math.min(3, Math.max(1, Math.ceil((3 * (contact_s - t_s)) / contact_s))));
}

/** A time as people say it. */
export function timeText(duration_s: number): string {
  return duration_s >= 1 ? `${duration_s.toFixed(1)} s` : `${Math.round(1000 * duration_s)} ms`;
}
