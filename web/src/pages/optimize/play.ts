/** One trial that is played: the channel to the button under test, and the bullet on the screen. */

import { type LiveChannel, live } from "../../net";
import type { Channels, PlayKept, PlayReady } from "../../net/messages";
import type { Game, InputDevice, Round, Strip } from "../../play/game";
import type { Played } from "../../play/hand";
import { Clocks, Player } from "../../play/player";
import { onCleanup, type Signal, signal } from "../../ui";
import { Clicker } from "../press/sound";

/** No device is pressed: the simulated button, with key, mouse or touch. */
export const SIMULATED = "";
/** The same with a key of the person's keyboard that tells how deep it is; no device is called so. */
export const ANALOG = "analog key of this page";
/** So often the server's clock is asked for once it is known. */
const LATER_ms = 500;

export interface PlayOptions {
  readonly strip: () => Strip;
  /** Draw the pixel that is lit, or none. */
  readonly draw: (lit_px: number | null) => void;
  /** The trial was played to its end. */
  readonly finished: (trial: number) => void;
}

/** A button under test is put away, is being fetched, is there. */
export type PlayStatus = "away" | "opening" | "there";

export class Play implements Played {
  readonly standing: Signal<PlayStatus> = signal<PlayStatus>("away");
  readonly game: Signal<Game | null>;
  readonly trial: Signal<number | null> = signal<number | null>(null);
  readonly reason: Signal<string> = signal("");
  /** The rounds of this trial, in order, as the server keeps them. */
  readonly rounds: Signal<readonly PlayKept[]> = signal<readonly PlayKept[]>([]);
  /** The device that is pressed; empty: what the hand does on the page is a press. */
  readonly device: Signal<string> = signal(SIMULATED);
  readonly clicker = new Clicker();
  readonly clocks: Clocks;
  private readonly player: Player;
  private readonly channel: LiveChannel<"play">;
  private run = 0;

  constructor(private readonly options: PlayOptions) {
    this.channel = live().channel("play", {
      onMessage: (message) => this.take(message),
      wrong: (line) => this.away(line),
      opened: () => {
        this.clocks?.reset();
        // asked for before there was a connection
        if (this.standing.peek() === "opening") this.ask();
      },
      lost: () =>
        this.standing.peek() !== "away" && this.away("The connection was lost: this trial starts again."),
    });
    this.clocks = new Clocks((said) => this.channel.send(said), LATER_ms);
    this.player = new Player({
      clocks: this.clocks,
      strip: options.strip,
      draw: options.draw,
      released: (at_ms) => this.channel.send({ type: "up", at_ms }),
      over: (over) => this.tell(over),
    });
    this.game = this.player.game;
    onCleanup(() => {
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
    this.player.pause();
  }

  resume(): void {
    this.player.resume();
  }

  playing(): boolean {
    return this.standing.peek() === "there" && this.player.playing();
  }

  /** The hand pressed, at an event's time. */
  press(at_ms: number, hand: InputDevice): void {
    if (this.device.peek() !== SIMULATED || !this.player.press(at_ms, hand)) return;
    this.channel.send({ type: "down", at_ms });
    this.clicker.wake();
  }

  /** The key of an analog keyboard is so deep: the server knows where the button under test goes down. */
  follow(at_ms: number, displacement_mm: number, velocity_mm_s: number): void {
    if (!this.player.playing() || this.device.peek() !== ANALOG) return;
    this.channel.send({ type: "follow", at_ms, displacement_mm, velocity_mm_s });
  }

  /** The key or pointer was released. */
  release(at_ms: number): void {
    this.player.release(at_ms);
  }

  private take(message: Channels["play"]["tells"]): void {
    if (message.type === "pong") this.clocks.take(message.sent_ms, message.server_ms);
    else if (message.type === "ready") this.begin(message);
    else if (message.type === "kept") this.keep(message);
    else if (message.type === "click")
      this.clocks.click(this.clicker, message.slot, message.server_ms, message.velocity_mm_s);
    else if (this.standing.peek() !== "away") this.away(message.reason);
  }

  private begin(ready: PlayReady): void {
    if (ready.run !== this.run || ready.trial !== this.trial.peek() || this.standing.peek() !== "opening")
      return;
    this.clicker.load(ready.signals);
    this.player.begin(ready.rounds, (ready.run * 1009 + ready.trial) * 1013 + ready.attempt);
    this.standing.set("there");
  }

  private tell(over: Round): void {
    const hand = this.device.peek() === ANALOG ? "analog" : over.hand;
    const timed = this.clocks.timed(over, over.target_ms, this.beside() ? "button" : hand);
    this.channel.send({ ...timed, target_ms: over.target_ms });
  }

  private keep(message: PlayKept): void {
    if (!this.player.keep(message.number)) return;
    this.rounds.update((list) => [...list, message]);
    if (!message.finished) return;
    const trial = this.trial.peek();
    this.away("");
    if (trial !== null) this.options.finished(trial);
  }

  private away(reason: string): void {
    this.player.away();
    this.standing.set("away");
    this.reason.set(reason);
  }
}
