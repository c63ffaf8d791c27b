/** Delays between page and person: what is stated until somebody measures it, kept in this browser. */

import { type Signal, signal } from "../ui";
import type { InputDevice } from "./game";

/** A delay and how far it may be off, ms. */
export interface Delay {
  readonly ms: number;
  readonly error_ms: number;
}

export interface Delays {
  /** From drawing a picture to its light; null: as the screen's pace lets expect. */
  readonly display: Delay | null;
  readonly input: Readonly<Record<InputDevice, Delay>>;
}

const KEY = "fdvv-delays";
/** From the finger to the browser's event, stated and not measured: scan, debounce, a poll of the bus. */
const STATED: Delays = {
  display: null,
  input: {
    key: { ms: 10, error_ms: 8 },
    // no debounce: its scan and a poll of the bus
    analog: { ms: 4, error_ms: 3 },
    mouse: { ms: 6, error_ms: 5 },
    touch: { ms: 30, error_ms: 20 },
    pen: { ms: 20, error_ms: 15 },
  },
};
/** A picture is composed for the refresh after its own and held for one; panels take some ms to follow. */
const FRAMES = 1.5;
const PANEL_ms = 5;
const MOST_ms = 1000;

export const delays: Signal<Delays> = signal(remembered());

export function setDelays(next: Delays): void {
  delays.set(next);
  localStorage.setItem(KEY, JSON.stringify(next));
}

/** Return the display delay that is used with a screen of a pace: measured if it was, else stated to a frame. */
export function displayDelay(now: Delays, frame_ms: number): Delay {
  return now.display ?? { ms: FRAMES * frame_ms + PANEL_ms, error_ms: frame_ms };
}

/** Read what this browser keeps; anything that is none of it gives what is stated. */
export function readDelays(text: string | null): Delays {
  try {
    const found = JSON.parse(text ?? "null") as Delays | null;
    const known = found && (found.display === null || whole(found.display));
    if (!known) return STATED;
    // what was kept before there was a kind of input has none of it
    const input = { ...STATED.input, ...found.input };
    return Object.values(input).every(whole) ? { ...found, input } : STATED;
  } catch {
    return STATED;
  }
}

function remembered(): Delays {
  return readDelays(localStorage.getItem(KEY));
}

function whole(delay: Delay | undefined): boolean {
  return !!delay && [delay.ms, delay.error_ms].every((ms) => Number.isFinite(ms) && ms >= 0 && ms <= MOST_ms);
}

/** The pace of a screen from the times of its pictures: their middle distance, steadier than any single one. */
export class FrameClock {
  private readonly last: number[] = [];

  take(now_ms: number): void {
    this.last.push(now_ms);
    if (this.last.length > 61) this.last.shift();
  }

  /** Return the time between two pictures; 60 Hz until some were seen. */
  frame_ms(): number {
    const gaps = this.last
      .slice(1)
      .map((at, i) => at - (this.last[i] as number))
      .sort((a, b) => a - b);
    return gaps.length < 5 ? 1000 / 60 : (gaps[gaps.length >> 1] as number);
  }
}
