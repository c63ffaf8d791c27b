/** Temporal pointing as it is played: the pictures of the bullet, the hand, and the two clocks. */

import { ClockSync } from "../net";
import { onCleanup, type Signal, signal } from "../ui";
import { type Delay, delays, displayDelay, FrameClock } from "./delays";
import {
  drawn,
  type Game,
  type InputDevice,
  kept,
  listens,
  lit_px,
  newGame,
  paused,
  pressed,
  type Round,
  resumed,
  round,
  type Strip,
} from "./game";

/** A clock that is not known yet is asked often, later now and then; this tells the server too that somebody is here. */
const SOON_ms = 80;
const FIRST = 12;

/** What presses: a hand on the page, or a device beside it, which tells its own times. */
export type RoundHand = InputDevice | "button";

/** A round with all that times it, as the server takes it. */
export interface TimedRound extends Omit<Round, "hand" | "target_ms"> {
  readonly type: "round";
  /** Null where the task sets no time. */
  readonly target_ms: number | null;
  readonly hand: RoundHand;
  readonly display: Delay;
  readonly input: Delay;
  readonly clock_ms: number | null;
  readonly clock_error_ms: number | null;
  readonly frame_ms: number;
}

/** What the hand did, and a question for the server's clock. */
export type Said =
  | { readonly type: "down" | "up"; readonly at_ms: number }
  | { readonly type: "ping"; readonly sent_ms: number };

/** A loudspeaker that is led by the server's clock. */
export interface Clicks {
  follow(now_s: number): void;
  click(slot: number, t_s: number, velocity_mm_s: number): void;
}

/** The clocks of one screen: the server's against the page's, and the pace of the pictures. */
export class Clocks {
  readonly server = new ClockSync();
  readonly frames = new FrameClock();
  private asked = 0;

  /** Ask for the server's clock until the scope ends, every later_ms once it is known. */
  constructor(send: (said: Said) => void, later_ms: number) {
    let timer = 0;
    const ask = () => {
      send({ type: "ping", sent_ms: performance.now() });
      timer = window.setTimeout(ask, this.asked++ < FIRST ? Math.min(SOON_ms, later_ms) : later_ms);
    };
    ask();
    onCleanup(() => clearTimeout(timer));
  }

  /** Another server may answer from now on. */
  reset(): void {
    this.server.reset();
  }

  /** The server's clock came back. */
  take(sent_ms: number, server_ms: number): void {
    this.server.take({ sent_ms, back_ms: performance.now(), server_ms });
  }

  /** A vibration starts at a time of the server's: have it heard then. */
  click(to: Clicks, slot: number, server_ms: number, velocity_mm_s: number): void {
    const page_ms = performance.now();
    const clock = this.server.at(page_ms);
    if (!clock) return;
    to.follow((page_ms + clock.offset_ms) / 1000);
    to.click(slot, server_ms / 1000, velocity_mm_s);
  }

  /** Write a round with all that times it. */
  timed(over: Omit<Round, "hand" | "target_ms">, target_ms: number | null, hand: RoundHand): TimedRound {
    const frame_ms = this.frames.frame_ms();
    const clock = this.server.at(performance.now());
    return {
      type: "round",
      number: over.number,
      start_ms: over.start_ms,
      target_ms,
      end_ms: over.end_ms,
      hand,
      display: displayDelay(delays.peek(), frame_ms),
      input: hand === "button" ? { ms: 0, error_ms: 0 } : delays.peek().input[hand],
      clock_ms: clock?.offset_ms ?? null,
      clock_error_ms: clock ? Math.min(1000, clock.error_ms) : null,
      frame_ms: Math.min(1000, frame_ms),
    };
  }
}

export interface PlayerOptions {
  readonly clocks: Clocks;
  readonly strip: () => Strip;
  /** Draw the pixel that is lit, or none. */
  readonly draw: (lit_px: number | null) => void;
  /** The hand was let go. */
  readonly released: (at_ms: number) => void;
  /** A round is over: it waits until it is kept. */
  readonly over: (round: Round) => void;
}

/** The bullet on a screen, from a trial's first round to its last; ends with its scope. */
export class Player {
  readonly game: Signal<Game | null> = signal<Game | null>(null);
  private pictures = 0;
  private down = false;
  private luck: () => number = () => 0;

  constructor(private readonly options: PlayerOptions) {
    const hidden = () => document.hidden && this.pause();
    document.addEventListener("visibilitychange", hidden);
    onCleanup(() => {
      document.removeEventListener("visibilitychange", hidden);
      cancelAnimationFrame(this.pictures);
    });
  }

  /** Begin with the next picture. seed: of the waits. kept: rounds of the trial that are kept already. */
  begin(rounds: number, seed: number, kept = 0): void {
    this.luck = lots(seed);
    this.game.set(newGame(this.options.strip(), rounds, kept));
    cancelAnimationFrame(this.pictures);
    this.pictures = requestAnimationFrame((now_ms) => this.picture(now_ms));
  }

  pause(): void {
    this.release(performance.now());
    this.game.update((game) => game && paused(game));
  }

  resume(): void {
    this.game.update((game) => game && resumed(game));
  }

  /** Whether the hand may press now: a trial is there and does not pause. */
  playing(): boolean {
    const game = this.game.peek();
    return !!game && game.phase !== "pause";
  }

  /** Take a press of the hand; false where it is none of a round. */
  press(at_ms: number, hand: InputDevice): boolean {
    const game = this.game.peek();
    if (!game || !listens(game) || this.down) return false;
    this.down = true;
    this.game.set(pressed(game, { at_ms, hand }));
    return true;
  }

  /** The key or pointer was released. */
  release(at_ms: number): void {
    if (!this.down) return;
    this.down = false;
    this.options.released(at_ms);
  }

  /** The round that waits is kept; false if it is another one. */
  keep(number: number): boolean {
    const game = this.game.peek();
    if (!game || game.kept + 1 !== number) return false;
    this.game.set(kept(game, number));
    return true;
  }

  /** Put the bullet away. */
  away(): void {
    cancelAnimationFrame(this.pictures);
    this.down = false;
    this.game.set(null);
    this.options.draw(null);
  }

  /** Draw what belongs to this picture of the screen; nothing of a press is ever drawn. */
  private picture(now_ms: number): void {
    const game = this.game.peek();
    if (!game) return;
    this.options.clocks.frames.take(now_ms);
    const next = drawn(game, now_ms, game.phase === "wait" && game.from_ms === null ? this.luck() : 0);
    this.options.draw(lit_px(next, now_ms));
    if (next !== game) this.game.set(next);
    if (next.phase === "keep" && game.phase !== "keep") this.end(next);
    if (next.phase !== "over") this.pictures = requestAnimationFrame((later_ms) => this.picture(later_ms));
  }

  private end(game: Game): void {
    const over = round(game);
    if (!over) return;
    this.release(performance.now());
    this.options.over(over);
  }
}

/** Numbers in [0, 1) from a seed, the same every time (mulberry32). */
function lots(seed: number): () => number {
  let state = seed >>> 0;
  return () => {
    state = (state + 0x6d2b79f5) >>> 0;
    let z = Math.imul(state ^ (state >>> 15), state | 1);
    z ^= z + Math.imul(z ^ (z >>> 7), z | 61);
    return ((z ^ (z >>> 14)) >>> 0) / 2 ** 32;
  };
}
