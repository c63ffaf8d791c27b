/** A participant's screen of a timing study: the channel, and the trial that is played, as signals. */

import { type LiveChannel, live } from "../../../net";
import type { Channels, TimingReady, TimingStepMessage, TimingTrial } from "../../../net/messages";
import type { InputDevice, Round, Strip } from "../../../play/game";
import type { Played } from "../../../play/hand";
import { Clocks, Player } from "../../../play/player";
import { type StripView, stripView } from "../../../play/strip";
import { onCleanup, type Signal, signal } from "../../../ui";
import { Clicker } from "../../press/sound";
import { SeatedSession } from "../seated";
import { TapPlayer } from "./tap_player";

type Tell = Channels["timing"]["tells"];
type Ask = Channels["timing"]["asks"];
/** Nothing is under the finger; it is being put there; the rounds go on. */
export type TrialStatus = "away" | "opening" | "there";

/** So often the server's clock is asked for while a trial is open. */
const PING_ms = 200;
const NO_STRIP: Strip = { pixels: 144, zone_px: 100, zone_half_px: 5, speed_px_s: 100 };

export class TimingSession extends SeatedSession<TimingStepMessage> implements Played {
  readonly status: Signal<TrialStatus> = signal<TrialStatus>("away");
  readonly ready: Signal<TimingReady | null> = signal<TimingReady | null>(null);
  /** Rounds of this trial that the server has on its disk. */
  readonly kept: Signal<number> = signal(0);
  readonly lights: StripView;
  readonly player: Player;
  readonly tapping: TapPlayer;
  readonly clicker = new Clicker();
  private readonly clocks: Clocks;
  private channel: LiveChannel<"timing"> | null = null;

  constructor(study: string, seat: string) {
    super(study, seat);
    this.clocks = new Clocks((said) => this.status.peek() !== "away" && this.send(said), PING_ms);
    this.lights = stripView(() => this.trial()?.strip ?? NO_STRIP);
    this.player = new Player({
      clocks: this.clocks,
      strip: () => this.trial()?.strip ?? NO_STRIP,
      draw: this.lights.draw,
      released: (at_ms) => this.send({ type: "up", at_ms }),
      over: (over) => this.tell(over, over.target_ms, over.hand),
    });
    this.tapping = new TapPlayer(this.clocks, (over, hand) => this.tell(over, null, hand));
    this.channel = live().channel("timing", {
      onMessage: (message) => this.take(message),
      wrong: (line) => this.refused(line),
      opened: (channel) => {
        this.channel = channel;
        this.clocks.reset();
        this.opened();
      },
      lost: () => {
        this.away();
        this.left();
      },
    });
    const blurred = () => this.status.peek() === "there" && !this.beside() && this.pause();
    addEventListener("blur", blurred);
    onCleanup(() => {
      removeEventListener("blur", blurred);
      this.channel?.close();
      this.clicker.close();
    });
  }

  /** The trial that is due, or whose switch is to be put on the table. */
  trial(): TimingTrial | null {
    return this.step()?.trial ?? null;
  }

  /** Whether a device on the table is pressed, which tells its own times. */
  beside(): boolean {
    return this.ready()?.on === "device";
  }

  /** The switch or key is under the finger: it was pressed. */
  placed(): void {
    const trial = this.trial();
    if (trial && !this.waiting.peek()) this.expect(() => this.send({ type: "placed", number: trial.number }));
  }

  /** Begin the trial, or go on with it. */
  start(): void {
    const trial = this.trial();
    if (!trial || this.status.peek() !== "away") return;
    this.clicker.wake();
    this.reason.set("");
    if (this.send({ type: "begin", number: trial.number })) this.status.set("opening");
  }

  /** Ask again whether it goes on: the time of waiting may be over. */
  again(): void {
    this.opened();
  }

  /** Whether the person has stopped for a while. */
  resting(): boolean {
    return this.player.game()?.phase === "pause" || this.tapping.stopped();
  }

  /** Stop for a while: what is under way is done again. */
  pause(): void {
    this.player.pause();
    this.tapping.stop();
  }

  goOn(): void {
    // seconds of tapping follow each other: the trial begins anew
    if (this.tapping.stopped()) {
      this.away();
      this.start();
    } else this.player.resume();
  }

  playing(): boolean {
    if (this.status.peek() !== "there" || this.lost.peek() || this.paused.peek()) return false;
    return this.trial()?.strip ? this.player.playing() : this.tapping.playing();
  }

  /** The hand pressed, at an event's time. */
  press(at_ms: number, hand: InputDevice): void {
    if (this.beside()) return;
    const counts = this.trial()?.strip ? this.player.press(at_ms, hand) : this.tapping.press(at_ms, hand);
    if (!counts) return;
    this.send({ type: "down", at_ms });
    this.clicker.wake();
  }

  /** The key or pointer was released. */
  release(at_ms: number): void {
    this.player.release(at_ms);
    if (this.tapping.release()) this.send({ type: "up", at_ms });
  }

  protected send(ask: Ask): boolean {
    return this.channel?.send(ask) ?? false;
  }

  private take(message: Tell): void {
    if (message.type === "pong") this.clocks.take(message.sent_ms, message.server_ms);
    else if (message.type === "click")
      this.clocks.click(this.clicker, message.slot, message.server_ms, message.velocity_mm_s);
    else if (message.type === "ready") this.open(message);
    else if (message.type === "kept") this.takeKept(message.number);
    else if (message.type === "step") this.takeStep(message);
    else if (message.type === "broke") this.mend();
    else {
      this.takeSeated(message);
      if (message.type === "paused" && message.on) this.pause();
    }
  }

  protected stepped(step: TimingStepMessage): void {
    this.kept.set(step.trial?.kept ?? 0);
  }

  private open(ready: TimingReady): void {
    if (this.status.peek() !== "opening" || ready.number !== this.trial()?.number) return;
    this.clicker.load(ready.signals);
    this.kept.set(ready.kept);
    this.ready.set(ready);
    this.status.set("there");
    if (this.trial()?.strip) this.player.begin(ready.rounds, ready.number * 1013 + ready.attempt, ready.kept);
    else this.tapping.begin(ready.rounds, this.beside());
  }

  private tell(over: Omit<Round, "hand" | "target_ms">, target_ms: number | null, hand: InputDevice): void {
    this.send(this.clocks.timed(over, target_ms, this.beside() ? "button" : hand));
  }

  private takeKept(number: number): void {
    this.kept.set(number);
    this.player.keep(number);
  }

  /** The button is gone: the same trial is put under the finger again. */
  private mend(): void {
    if (this.status.peek() === "away") return;
    this.away();
    this.start();
  }

  protected override refused(line: string): void {
    this.away();
    super.refused(line);
  }

  /** Nothing is under the finger. */
  protected away(): void {
    this.player.away();
    this.tapping.away();
    this.status.set("away");
    this.ready.set(null);
  }
}
