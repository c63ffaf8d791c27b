/** What taps along with a regular flash tell of the delays between page and person. */

/** People tap ahead of a beat, and do not notice: 20 to 80 ms in the literature. It cannot be distinguished from a delay. */
export const AHEAD = { ms: 50, error_ms: 30 } as const;
const LEAST = 8;
/** The first taps only find the beat. */
const SKIPPED = 3;

export interface Tapped {
  readonly count: number;
  /** Mean of tap less flash as drawn, ms, and its standard error. */
  readonly late_ms: number;
  readonly late_error_ms: number;
  /** Spread between taps, one standard deviation. */
  readonly spread_ms: number;
  /** Delay of screen and hand together, and how far it may be off, people's lead among it. */
  readonly both_ms: number;
  readonly both_error_ms: number;
}

/** Read taps (ms) at flashes drawn every period from start on; null while there are too few. */
export function tapped(taps_ms: readonly number[], start_ms: number, period_ms: number): Tapped | null {
  const late = taps_ms
    .slice(SKIPPED)
    .map((at) => wrapped(at - start_ms, period_ms))
    .sort((a, b) => a - b);
  if (late.length < LEAST) return null;
  // one tap that was missed or made twice must not move the rest
  const cut = Math.floor(late.length / 10);
  const kept = late.slice(cut, late.length - cut);
  const mean = kept.reduce((sum, one) => sum + one, 0) / kept.length;
  const spread_ms = Math.sqrt(kept.reduce((sum, one) => sum + (one - mean) ** 2, 0) / (kept.length - 1));
  const late_error_ms = spread_ms / Math.sqrt(kept.length);
  return {
    count: kept.length,
    late_ms: mean,
    late_error_ms,
    spread_ms,
    both_ms: Math.max(0, mean + AHEAD.ms),
    both_error_ms: Math.hypot(AHEAD.error_ms, late_error_ms),
  };
}

/** Return how far a time is from the nearest flash: from minus to plus half a period. */
function wrapped(since_ms: number, period_ms: number): number {
  return since_ms - period_ms * Math.round(since_ms / period_ms);
}
