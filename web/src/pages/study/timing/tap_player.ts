/** Tapping on a screen: the seconds that pass, and the hand. */

import type { InputDevice } from "../../../play/game";
import type { Clocks } from "../../../play/player";
import {
  newTapping,
  secondOver,
  secondsLeft,
  type Tapping,
  type TapRound,
  tappedAt,
  taps,
} from "../../../play/tapping";
import { onCleanup, type Signal, signal } from "../../../ui";

/** One trial of tapping after the other; ends with its scope. */
export class TapPlayer {
  /** Whole seconds that are left; null while nothing is tapped. */
  readonly left_s: Signal<number | null> = signal<number | null>(null);
  /** The person stopped in the middle. */
  readonly stopped: Signal<boolean> = signal(false);
  private now: Tapping | null = null;
  private hand: InputDevice = "key";
  private down = false;
  private pictures = 0;

  constructor(
    private readonly clocks: Clocks,
    private readonly over: (over: TapRound, hand: InputDevice) => void,
  ) {
    const hidden = () => document.hidden && this.stop();
    document.addEventListener("visibilitychange", hidden);
    onCleanup(() => {
      document.removeEventListener("visibilitychange", hidden);
      cancelAnimationFrame(this.pictures);
    });
  }

  /** Wait for the first tap; atOnce: a device is tapped, of which the page hears nothing. */
  begin(seconds: number, atOnce: boolean): void {
    this.now = newTapping(seconds);
    if (atOnce) this.now = tappedAt(this.now, performance.now());
    this.left_s.set(seconds);
    this.stopped.set(false);
    cancelAnimationFrame(this.pictures);
    this.pictures = requestAnimationFrame((now_ms) => this.picture(now_ms));
  }

  playing(): boolean {
    return this.now !== null && !this.stopped.peek();
  }

  /** Take a tap; false where it is none. */
  press(at_ms: number, hand: InputDevice): boolean {
    if (!this.now || this.stopped.peek() || this.down || !taps(this.now, at_ms)) return false;
    this.down = true;
    this.hand = hand;
    this.now = tappedAt(this.now, at_ms);
    return true;
  }

  /** The hand let go; false where it was not down. */
  release(): boolean {
    const was = this.down;
    this.down = false;
    return was;
  }

  /** Stop in the middle: it is begun anew. */
  stop(): void {
    if (this.now) this.stopped.set(true);
    cancelAnimationFrame(this.pictures);
  }

  away(): void {
    cancelAnimationFrame(this.pictures);
    this.now = null;
    this.down = false;
    this.left_s.set(null);
    this.stopped.set(false);
  }

  private picture(now_ms: number): void {
    if (!this.now) return;
    this.clocks.frames.take(now_ms);
    const found = secondOver(this.now, now_ms);
    if (found) {
      this.now = found[1];
      this.over(found[0], this.hand);
    }
    const left_s = secondsLeft(this.now, now_ms);
    if (left_s !== this.left_s.peek()) this.left_s.set(left_s);
    if (this.now.sent < this.now.seconds)
      this.pictures = requestAnimationFrame((later_ms) => this.picture(later_ms));
  }
}
