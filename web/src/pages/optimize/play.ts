/** One trial that is played: the channel to the button under test, the clocks, and the game on the screen. */

import { ClockSync, type LiveChannel, live } from "../../net";
import type { Channels, PlayKept, PlayReady } from "../../net/messages";
import { onCleanup, type Signal, signal } from "../../ui";
import { Clicker } from "../press/sound";
import { delays, displayDelay, FrameClock } from "./delays";
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
  resumed,
  round,
  type Strip,
} from "./game";

/** No device is pressed: the simulated button, with key, mouse or touch. */
export const SIMULATED = "";
/** The same with a key of the person's keyboard that tells how deep it is; no device is called so. */
export const ANALOG = "analog key of this page";
/** A clock that is not known yet is asked often, later now and then; this tells the server too that somebody is here. */
const SOON_ms = 80;
const LATER_ms = 500;
const FIRST = 12;

export interface PlayOptions {
  readonly strip: () => Strip;
  /** Draw the pixel that is lit, or none. */
  readonly draw: (lit_px: number | null) => void;
  /** The trial was played to its end. */
  readonly finished: (trial: number) => void;
}

/** A button under test is put away, is being fetched, is there. */
export type PlayStatus = "away" | "opening" | "there";

export class Play {
  readonly standing: Signal<PlayStatus> = signal<PlayStatus>("away");
  readonly game: Signal<Game | null> = signal<Game | null>(null);
  readonly trial: Signal<number | null> = signal<number | null>(null);
  readonly reason: Signal<string> = signal("");
  /** The rounds of this trial, in order, as the server keeps them. */
  readonly rounds: Signal<readonly PlayKept[]> = signal<readonly PlayKept[]>([]);
  /** The device that is pressed; empty: what the hand does on the page is a press. */
  readonly device: Signal<string> = signal(SIMULATED);
  readonly clock = new ClockSync();
  readonly frameClock = new FrameClock();
  readonly clicker = new Clicker();
  private readonly channel: LiveChannel<"play">;
  private run = 0;
  private asked = 0;
  private pictures = 0;
  private down = false;
  private luck: () => number = () => 0;

  constructor(private readonly options: PlayOptions) {
    this.channel = live().channel("play", {
      onMessage: (message) => this.take(message),
      wrong: (line) => this.away(line),
      opened: () => {
        this.clock.reset();
        // asked for before there was a connection
        if (this.standing.peek() === "opening") this.ask();
      },
      lost: () =>
        this.standing.peek() !== "away" && this.away("The connection was lost: this trial starts again."),
    });
    const hidden = () => document.hidden && this.pause();
    document.addEventListener("visibilitychange", hidden);
    let timer = 0;
    const ask = () => {
      this.channel.send({ type: "ping", sent_ms: performance.now() });
      timer = window.setTimeout(ask, this.asked++ < FIRST ? SOON_ms : LATER_ms);
    };
    ask();
    onCleanup(() => {
      clearTimeout(timer);
      document.removeEventListener("visibilitychange", hidden);
      cancelAnimationFrame(this.pictures);
      if (this.standing.peek() !== "away") this.channel.send({ type: "close" });
      this.channel.close();
      this.clicker.close();
    });
  }

  /** Put the button of a trial under the finger; its rounds begin with the first picture after that. */
  open(run: number, trial: number, device: string): void {
    this.run = run;
    this.device.set(device);
    this.trial.set(trial);
    this.rounds.set([]);
    this.reason.set("");
    this.standing.set("opening");
    if (!this.ask() && live().state.peek() === "lost") this.away("The studio does not answer.");
  }

  private ask(): boolean {
    return this.channel.send({
      type: "open",
      run: this.run,
      trial: this.trial.peek() ?? 0,
      device: this.beside() ? this.device.peek() : SIMULATED,
    });
  }

  /** Whether a device beside the page is pressed. */
  beside(): boolean {
    return this.device() !== SIMULATED && this.device() !== ANALOG;
  }

  /** Put the button away; rounds of an unfinished trial are kept and do not count. */
  close(): void {
    if (this.standing.peek() !== "away") this.channel.send({ type: "close" });
    this.away("");
  }

  pause(): void {
    this.release(performance.now());
    this.game.update((game) => game && paused(game));
  }

  resume(): void {
    this.game.update((game) => game && resumed(game));
  }

  /** The hand pressed, at an event's time. */
  press(at_ms: number, hand: InputDevice): void {
    const game = this.game.peek();
    if (!game || !listens(game) || this.down || this.device.peek() !== SIMULATED) return;
    this.down = true;
    this.channel.send({ type: "down", at_ms });
    this.game.set(pressed(game, { at_ms, hand }));
    this.clicker.wake();
  }

  /** The key of an analog keyboard is so deep: the server knows where the button under test goes down. */
  follow(at_ms: number, displacement_mm: number, velocity_mm_s: number): void {
    const game = this.game.peek();
    if (!game || game.phase === "pause" || this.device.peek() !== ANALOG) return;
    this.channel.send({ type: "follow", at_ms, displacement_mm, velocity_mm_s });
  }

  /** The key or pointer was released. */
  release(at_ms: number): void {
    if (!this.down) return;
    this.down = false;
    this.channel.send({ type: "up", at_ms });
  }

  private take(message: Channels["play"]["tells"]): void {
    if (message.type === "pong") {
      this.clock.take({ sent_ms: message.sent_ms, back_ms: performance.now(), server_ms: message.server_ms });
    } else if (message.type === "ready") this.begin(message);
    else if (message.type === "kept") this.keep(message);
    else if (message.type === "click") this.click(message.slot, message.server_ms, message.velocity_mm_s);
    else if (this.standing.peek() !== "away") this.away(message.reason);
  }

  private begin(ready: PlayReady): void {
    if (ready.run !== this.run || ready.trial !== this.trial.peek() || this.standing.peek() !== "opening")
      return;
    this.clicker.load(ready.signals);
    this.luck = lots((ready.run * 1009 + ready.trial) * 1013 + ready.attempt);
    this.game.set(newGame(this.options.strip(), ready.rounds));
    this.standing.set("there");
    cancelAnimationFrame(this.pictures);
    this.pictures = requestAnimationFrame((now_ms) => this.picture(now_ms));
  }

  /** Draw what belongs to this picture of the screen; nothing of a press is ever drawn. */
  private picture(now_ms: number): void {
    const game = this.game.peek();
    if (!game) return;
    this.frameClock.take(now_ms);
    const next = drawn(game, now_ms, game.phase === "wait" && game.from_ms === null ? this.luck() : 0);
    this.options.draw(lit_px(next, now_ms));
    if (next !== game) this.game.set(next);
    if (next.phase === "keep" && game.phase !== "keep") this.tell(next);
    if (next.phase !== "over") this.pictures = requestAnimationFrame((later_ms) => this.picture(later_ms));
  }

  private tell(game: Game): void {
    const over = round(game);
    if (!over) return;
    this.release(performance.now());
    const frame_ms = this.frameClock.frame_ms();
    const clock = this.clock.at(performance.now());
    const beside = this.beside();
    const hand = this.device.peek() === ANALOG ? "analog" : over.hand;
    this.channel.send({
      type: "round",
      ...over,
      hand: beside ? "button" : hand,
      display: displayDelay(delays.peek(), frame_ms),
      input: beside ? { ms: 0, error_ms: 0 } : delays.peek().input[hand],
      clock_ms: clock?.offset_ms ?? null,
      clock_error_ms: clock ? Math.min(1000, clock.error_ms) : null,
      frame_ms: Math.min(1000, frame_ms),
    });
  }

  private keep(message: PlayKept): void {
    const game = this.game.peek();
    if (!game || game.kept + 1 !== message.number) return;
    this.rounds.update((list) => [...list, message]);
    this.game.set(kept(game, message.number));
    if (!message.finished) return;
    const trial = this.trial.peek();
    this.away("");
    if (trial !== null) this.options.finished(trial);
  }

  private click(slot: number, server_ms: number, velocity_mm_s: number): void {
    const page_ms = performance.now();
    const clock = this.clock.at(page_ms);
    if (!clock) return;
    this.clicker.follow((page_ms + clock.offset_ms) / 1000);
    this.clicker.click(slot, server_ms / 1000, velocity_mm_s);
  }

  private away(reason: string): void {
    cancelAnimationFrame(this.pictures);
    this.down = false;
    this.standing.set("away");
    this.game.set(null);
    this.reason.set(reason);
    this.options.draw(null);
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
