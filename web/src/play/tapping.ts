/** Tapping as fast as one can, as states, without a screen: seconds that follow each other, each one round. */

/** A second of tapping that is over; times of the page. */
export interface TapRound {
  readonly number: number;
  readonly start_ms: number;
  readonly end_ms: number;
}

export interface Tapping {
  readonly seconds: number;
  /** The first tap; null before it. */
  readonly from_ms: number | null;
  /** Seconds that were sent to the server. */
  readonly sent: number;
}

const SECOND_ms = 1000;
/** A second is sent so much later: a press takes its way through the simulated button first. */
export const SETTLE_ms = 300;
/** A press at the very end of a second belongs to the next one. */
const EDGE_ms = 1e-3;

export function newTapping(seconds: number): Tapping {
  return { seconds, from_ms: null, sent: 0 };
}

/** Whether what the hand does at a time is a tap. */
export function taps(now: Tapping, at_ms: number): boolean {
  return now.from_ms === null || at_ms < now.from_ms + SECOND_ms * now.seconds;
}

/** The hand tapped: the first tap begins the time. */
export function tappedAt(now: Tapping, at_ms: number): Tapping {
  return now.from_ms === null ? { ...now, from_ms: at_ms } : now;
}

/** Return the next second that is over, and the state in which it was sent; null where none is. */
export function secondOver(now: Tapping, at_ms: number): readonly [TapRound, Tapping] | null {
  const { from_ms, sent, seconds } = now;
  if (from_ms === null || sent >= seconds) return null;
  const start_ms = from_ms + SECOND_ms * sent;
  if (at_ms < start_ms + SECOND_ms + SETTLE_ms) return null;
  const over = { number: sent + 1, start_ms, end_ms: start_ms + SECOND_ms - EDGE_ms };
  return [over, { ...now, sent: sent + 1 }];
}

/** Return the seconds that are left, whole and rounded up. */
export function secondsLeft(now: Tapping, at_ms: number): number {
  if (now.from_ms === null) return now.seconds;
  return Math.max(0, Math.ceil(now.seconds - (at_ms - now.from_ms) / SECOND_ms));
}
