/** How long it takes from what the hand does to the frame that shows it. */

const KEPT = 500;

export class Latency {
  private readonly asked = new Map<number, number>();
  private readonly found_ms: number[] = [];
  private shown = 0;

  /** The hand did something at a time of `performance.now()`, sent with a number. */
  sent(sequence: number, at_ms: number): void {
    this.asked.set(sequence, at_ms);
  }

  /** A frame that had taken a number into account was drawn. Gives the delay, or null if it showed nothing new. */
  drawn(sequence: number, now_ms: number): number | null {
    if (sequence <= this.shown) return null;
    const first = [...this.asked.keys()].find((number) => number > this.shown && number <= sequence);
    const at_ms = first === undefined ? undefined : this.asked.get(first);
    for (const number of this.asked.keys()) if (number <= sequence) this.asked.delete(number);
    this.shown = sequence;
    if (at_ms === undefined) return null;
    this.found_ms.push(now_ms - at_ms);
    if (this.found_ms.length > KEPT) this.found_ms.shift();
    return now_ms - at_ms;
  }

  /** Return how many delays were found, their middle, and what 95 and 99 of 100 stay below; null before the first. */
  summary(): Readonly<Record<"count" | "median_ms" | "p95_ms" | "p99_ms", number>> | null {
    if (!this.found_ms.length) return null;
    const sorted = [...this.found_ms].sort((a, b) => a - b);
    const at = (part: number) =>
      sorted[Math.min(sorted.length - 1, Math.floor(part * sorted.length))] as number;
    return { count: sorted.length, median_ms: at(0.5), p95_ms: at(0.95), p99_ms: at(0.99) };
  }
}
