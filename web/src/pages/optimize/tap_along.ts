/** Tap along with a light: finds screens that are much later than stated. */

import { delays, type FrameClock, setDelays } from "../../play/delays";
import { onCleanup, type Signal, signal } from "../../ui";
import { type Tapped, tapped } from "./taps";

const PERIOD_ms = 800;
export const FLASHES = 24;
const LIT_ms = 120;

/** A light that flashes until it has flashed often enough, and the taps with it; ends with its scope. */
export class TapAlong {
  readonly taps: Signal<readonly number[]> = signal<readonly number[]>([]);
  readonly start_ms: Signal<number | null> = signal<number | null>(null);
  readonly found: Signal<Tapped | null> = signal<Tapped | null>(null);
  readonly lit: Signal<boolean> = signal(false);
  private pictures = 0;

  constructor(private readonly frameClock: FrameClock) {
    onCleanup(() => cancelAnimationFrame(this.pictures));
  }

  begin(): void {
    this.taps.set([]);
    this.found.set(null);
    this.start_ms.set(null);
    this.pictures = requestAnimationFrame((now_ms) => this.picture(now_ms));
  }

  tap(at_ms: number): void {
    if (this.start_ms.peek() !== null) this.taps.update((all) => [...all, at_ms]);
  }

  private picture(now_ms: number): void {
    this.frameClock.take(now_ms);
    if (this.start_ms.peek() === null) this.start_ms.set(now_ms);
    const since_ms = now_ms - (this.start_ms.peek() as number);
    this.lit.set(since_ms % PERIOD_ms < LIT_ms);
    if (since_ms < FLASHES * PERIOD_ms)
      this.pictures = requestAnimationFrame((later_ms) => this.picture(later_ms));
    else this.end();
  }

  private end(): void {
    this.found.set(tapped(this.taps.peek(), this.start_ms.peek() ?? 0, PERIOD_ms));
    this.lit.set(false);
    this.start_ms.set(null);
  }
}

/** Take what screen and hand are late together, less what is stated of the key, as the screen's delay. */
export function useForScreen(found: Tapped): void {
  const { key } = delays.peek().input;
  const error_ms = Math.hypot(found.both_error_ms, key.error_ms);
  setDelays({ ...delays.peek(), display: { ms: Math.max(0, found.both_ms - key.ms), error_ms } });
}
