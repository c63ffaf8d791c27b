/** How far the server's clock is from the page's: questions with their times, as NTP has them. */

/** One question and its answer, ms: sent and back on the page's clock, the server's clock in between. */
export interface ClockReading {
  readonly sent_ms: number;
  readonly back_ms: number;
  readonly server_ms: number;
}

/** The server's clock less the page's at a time, and how far that may be off, ms. */
export interface ClockOffset {
  readonly offset_ms: number;
  readonly error_ms: number;
}

/** Of each stretch only the quickest answer is kept, for waiting is never even. */
const STRETCH_ms = 2000;
const KEPT = 60;
/** A slope is accepted from so many stretches on, over so long, and no steeper: quartz is within 200 ppm. */
const FITTED = 6;
const LONG_ms = 15_000;
const STEEPEST = 5e-4;
/** Answers that took longer than the quickest by more than this tell nothing. */
const SLOW_ms = 1;

interface Point {
  readonly at_ms: number;
  readonly offset_ms: number;
  readonly trip_ms: number;
}

/**
 * The least-round-trip estimate of an offset that may drift.
 *
 * An answer that was back after `trip` leaves the offset unknown by half of it, however uneven the two ways are; so
 * the quickest ones count, and a line through them gives the drift.
 */
export class ClockSync {
  private points: readonly Point[] = [];

  /** Take an answer; one that came back before it was sent is none. */
  take(reading: ClockReading): void {
    const trip_ms = reading.back_ms - reading.sent_ms;
    if (!(trip_ms >= 0)) return;
    const at_ms = (reading.sent_ms + reading.back_ms) / 2;
    const point = { at_ms, offset_ms: reading.server_ms - at_ms, trip_ms };
    const last = this.points.at(-1);
    if (!last || stretch(last) !== stretch(point)) this.points = [...this.points, point].slice(-KEPT);
    else if (trip_ms < last.trip_ms) this.points = [...this.points.slice(0, -1), point];
  }

  /** Forget everything: another server may answer. */
  reset(): void {
    this.points = [];
  }

  /** Return the offset at a time of the page; null before the first answer. */
  at(page_ms: number): ClockOffset | null {
    const best = quickest(this.points);
    if (!best) return null;
    const good = this.points.filter((point) => point.trip_ms <= best.trip_ms + SLOW_ms);
    const { middle_ms, offset_ms, slope } = line(good, best);
    const worst_ms = Math.max(
      ...good.map((p) => Math.abs(p.offset_ms - offset_ms - slope * (p.at_ms - middle_ms))),
    );
    return { offset_ms: offset_ms + slope * (page_ms - middle_ms), error_ms: best.trip_ms / 2 + worst_ms };
  }

  /** Return the quickest round trip, ms, and how many stretches are known. */
  summary(): { readonly trip_ms: number; readonly count: number } | null {
    const best = quickest(this.points);
    return best ? { trip_ms: best.trip_ms, count: this.points.length } : null;
  }
}

function stretch(point: Point): number {
  return Math.floor(point.at_ms / STRETCH_ms);
}

function quickest(points: readonly Point[]): Point | null {
  return points.reduce<Point | null>(
    (best, point) => (best && best.trip_ms <= point.trip_ms ? best : point),
    null,
  );
}

interface Line {
  readonly middle_ms: number;
  readonly offset_ms: number;
  readonly slope: number;
}

/** Fit a line through the good points; level through the best one where they are few or close together. */
function line(good: readonly Point[], best: Point): Line {
  const span_ms = (good.at(-1)?.at_ms ?? 0) - (good[0]?.at_ms ?? 0);
  if (good.length < FITTED || span_ms < LONG_ms)
    return { middle_ms: best.at_ms, offset_ms: best.offset_ms, slope: 0 };
  const mean = (value: (point: Point) => number) =>
    good.reduce((sum, point) => sum + value(point), 0) / good.length;
  const middle_ms = mean((p) => p.at_ms);
  const offset_ms = mean((p) => p.offset_ms);
  const spread = mean((p) => (p.at_ms - middle_ms) ** 2);
  const slope = mean((p) => (p.at_ms - middle_ms) * (p.offset_ms - offset_ms)) / spread;
  return { middle_ms, offset_ms, slope: Math.min(STEEPEST, Math.max(-STEEPEST, slope)) };
}
