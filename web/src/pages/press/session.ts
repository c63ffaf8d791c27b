/** One live press: the channel to the simulated rig, and all that the page knows of it, as signals. */

import { type LiveChannel, live } from "../../net";
import type {
  Channels,
  PressFrame,
  PressHappened,
  PressMeant,
  PressReady,
  PressStart,
} from "../../net/messages";
import { batch, onCleanup, type Signal, signal } from "../../ui";
import { Latency } from "./latency";
import { Rolling } from "./rolling";

/** What is pressed: an id of a button or program, or a document that is not kept yet. */
export type What = Pick<PressStart, "button" | "program" | "model" | "code">;
export type Mode = PressReady["mode"];

export interface Choice {
  readonly what: What;
  readonly mode: Mode;
  readonly rig: string;
}

/** One press: where and under what force the key closed at first, where it opened at last, how deep the cap went. */
export interface Stroke {
  readonly clicked: { readonly displacement_mm: number; readonly force_cN: number } | null;
  readonly reset_mm: number | null;
  readonly deepest_mm: number;
}
const NO_STROKE: Stroke = { clicked: null, reset_mm: null, deepest_mm: 0 };

export type SessionStatus = "empty" | "starting" | "running" | "paused" | "lost" | "over";

/** A page that is looked at says so this often; the server waits three times as long. */
const HERE_ms = 1000;

export class PressSession {
  readonly standing: Signal<SessionStatus> = signal<SessionStatus>("empty");
  readonly reason: Signal<string> = signal("");
  readonly ready: Signal<PressReady | null> = signal<PressReady | null>(null);
  /** Target force at the speed of the last press; at first when pressed slowly. */
  readonly target: Signal<PressMeant | null> = signal<PressMeant | null>(null);
  /** The last frame. */
  readonly frame: Signal<PressFrame | null> = signal<PressFrame | null>(null);
  readonly presses: Signal<number> = signal(0);
  readonly actuations: Signal<number> = signal(0);
  readonly lastPress: Signal<PressHappened | null> = signal<PressHappened | null>(null);
  /** What happened in it; null before the first. */
  readonly stroke: Signal<Stroke | null> = signal<Stroke | null>(null);
  readonly fault: Signal<string> = signal("");
  /** Why the force loop is open; empty while it is not, and on rigs without one. */
  readonly opened: Signal<string> = signal("");
  readonly rows = new Rolling();
  readonly latency = new Latency();
  /** Called with every frame as soon as it arrives. */
  onFrame: (frame: PressFrame) => void = () => undefined;
  /** Called when something new is under the finger. */
  onReady: (ready: PressReady) => void = () => undefined;
  private readonly channel: LiveChannel<"press">;
  private choice: Choice | null = null;
  /** The press that is not over yet. */
  private going = NO_STROKE;
  private sequence = 0;

  constructor() {
    this.channel = live().channel("press", {
      onMessage: (message) => this.take(message),
      wrong: (line) => this.over(line),
      opened: () => this.choice && this.start(this.choice),
      lost: () => this.choice && this.standing.set("lost"),
    });
    this.watchVisibility();
    onCleanup(() => {
      this.channel.send({ type: "stop" });
      this.channel.close();
    });
  }

  /** Put something under the finger; counters begin anew. */
  start(choice: Choice): void {
    this.choice = choice;
    batch(() => {
      this.standing.set("starting");
      this.reason.set("");
      this.fault.set("");
      this.opened.set("");
    });
    this.channel.send({ type: "start", ...choice.what, mode: choice.mode, rig: choice.rig, seed: 0 });
  }

  travel_mm(): number | null {
    return this.ready.peek()?.travel_mm ?? null;
  }

  lead(referent_mm: number, velocity_mm_s: number, at_ms: number, near_1_s?: number): void {
    const near = near_1_s === undefined ? {} : { near_1_s: Math.min(1000, Math.max(1, near_1_s)) };
    this.send({ type: "lead", referent_mm, velocity_mm_s, sequence: this.next(at_ms), ...near });
  }

  follow(displacement_mm: number, velocity_mm_s: number, at_ms: number): void {
    this.send({ type: "follow", displacement_mm, velocity_mm_s, sequence: this.next(at_ms) });
  }

  push(force_cN: number, at_ms: number): void {
    this.send({ type: "push", force_cN, sequence: this.next(at_ms) });
  }

  lift(at_ms: number): void {
    this.send({ type: "lift", sequence: this.next(at_ms) });
  }

  replay(trace: {
    readonly name: string;
    readonly t_s?: readonly number[];
    readonly displacement_mm?: readonly number[];
  }): void {
    this.send({ type: "replay", ...trace });
  }

  hostEvent(number: number): void {
    this.send({ type: "event", number });
  }

  fail(): void {
    this.send({ type: "fail" });
  }

  clearFault(): void {
    this.fault.set("");
    this.send({ type: "clear" });
  }

  private next(at_ms: number): number {
    this.latency.sent(++this.sequence, at_ms);
    return this.sequence;
  }

  private send(ask: Channels["press"]["asks"]): void {
    if (this.standing.peek() === "paused") this.standing.set("running");
    this.channel.send(ask);
  }

  private take(message: Channels["press"]["tells"]): void {
    if (message.type === "frame") this.takeFrame(message);
    else if (message.type === "ready") this.takeReady(message);
    else if (message.type === "meant") this.target.set(message);
    else if (message.type === "refused") this.reason.set(message.reason);
    else if (message.reason) this.over(message.reason);
  }

  private takeReady(ready: PressReady): void {
    // of a choice that was changed before it was there
    if (ready.mode !== this.choice?.mode) return;
    this.rows.clear();
    this.going = NO_STROKE;
    batch(() => {
      this.ready.set(ready);
      this.target.set(ready.meant);
      this.frame.set(null);
      this.standing.set("running");
      this.presses.set(0);
      this.actuations.set(0);
      this.lastPress.set(null);
      this.stroke.set(null);
    });
    this.onReady(ready);
  }

  private takeFrame(frame: PressFrame): void {
    if (this.standing.peek() === "starting") return; // of what was there before
    this.rows.add(frame.t_s, frame.displacement_mm, frame.force_cN);
    batch(() => {
      this.frame.set(frame);
      for (const event of frame.events) this.takeEvent(event);
    });
    this.onFrame(frame);
  }

  private takeEvent(event: PressHappened): void {
    const { displacement_mm } = event;
    if (event.kind === "actuation") {
      this.actuations.update((n) => n + 1);
      const force_cN = this.rows.since(event.t_s).force_cN[0] ?? 0;
      this.going = { ...this.going, clicked: this.going.clicked ?? { displacement_mm, force_cN } };
    } else if (event.kind === "reset") this.going = { ...this.going, reset_mm: displacement_mm };
    else if (event.kind === "fault") this.fault.set(event.told);
    else if (event.kind === "loop") this.opened.set(event.told);
    else if (event.kind === "pressed") {
      this.opened.set("");
      this.presses.update((n) => n + 1);
      this.lastPress.set(event);
      this.stroke.set({ ...this.going, deepest_mm: displacement_mm });
      this.going = NO_STROKE;
    }
  }

  private over(reason: string): void {
    this.choice = null;
    batch(() => {
      this.standing.set("over");
      this.reason.set(reason);
    });
  }

  private watchVisibility(): void {
    const tell = () => {
      if (this.standing.peek() === "empty" || this.standing.peek() === "over") return;
      if (document.hidden) {
        this.channel.send({ type: "pause" });
        if (this.standing.peek() === "running") this.standing.set("paused");
      } else {
        this.channel.send({ type: "here" });
        if (this.standing.peek() === "paused") this.standing.set("running");
      }
    };
    const timer = setInterval(() => !document.hidden && tell(), HERE_ms);
    document.addEventListener("visibilitychange", tell);
    onCleanup(() => {
      clearInterval(timer);
      document.removeEventListener("visibilitychange", tell);
    });
  }
}
