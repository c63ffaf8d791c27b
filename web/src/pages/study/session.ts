/** One participant's screen: the channel to the study, and all that the page knows of its trial, as signals. */

import { type LiveChannel, live } from "../../net";
import type { Channels, StudyFrame, StudyReady, StudyStep } from "../../net/messages";
import { batch, onCleanup, type Signal, signal } from "../../ui";
import type { FingerTarget } from "../press/finger_input";
import { Draft } from "./answer";
import { SeatedSession } from "./seated";

type Tell = Channels["study"]["tells"];
type Ask = Channels["study"]["asks"];

export interface StudyView {
  onReady(ready: StudyReady): void;
  onFelt(): void;
  onFrame(frame: StudyFrame): void;
}

export class StudySession extends SeatedSession<StudyStep> implements FingerTarget {
  readonly draft: Signal<Draft | null> = signal<Draft | null>(null);
  /** What the trial's labels have in common, once they can be felt. */
  readonly ready: Signal<StudyReady | null> = signal<StudyReady | null>(null);
  /** What is under the finger, and what is being put there. */
  readonly felt: Signal<string> = signal("");
  readonly going: Signal<string> = signal("");
  readonly frame: Signal<StudyFrame | null> = signal<StudyFrame | null>(null);
  /** The trial that is shown: it hears of what it feels at once. */
  view: StudyView | null = null;
  private channel: LiveChannel<"study"> | null = null;

  constructor(study: string, seat: string) {
    super(study, seat);
    this.channel = live().channel("study", {
      onMessage: (message) => this.take(message),
      wrong: (line) => this.refused(line),
      opened: (channel) => {
        this.channel = channel;
        this.opened();
      },
      lost: () => this.left(),
    });
    onCleanup(() => this.channel?.close());
  }

  /** Bring a label under the finger. */
  go(label: string): void {
    const there = this.going.peek() || this.felt.peek();
    if (there === label || this.going.peek() || !this.draft.peek()?.task.places.includes(label)) return;
    this.going.set(label);
    // else as soon as the trial is made ready
    if (this.ready.peek()) this.send({ type: "go", label });
  }

  answer(): void {
    const draft = this.draft.peek();
    if (!draft?.complete() || this.waiting.peek()) return;
    this.expect(() =>
      this.send({
        type: "answer",
        number: draft.task.number,
        choice: draft.choice.peek(),
        ratings: draft.ratings.peek(),
      }),
    );
  }

  /** The button is a device on the table: nothing of it is drawn, and no hand is led. */
  onTable(): boolean {
    return this.ready()?.travel_mm === 0;
  }

  travel_mm(): number | null {
    return this.ready.peek()?.travel_mm ?? null;
  }

  lead(referent_mm: number, velocity_mm_s: number, _at_ms: number, near_1_s?: number): void {
    const near = near_1_s === undefined ? {} : { near_1_s: Math.min(1000, Math.max(1, near_1_s)) };
    this.hand({ type: "lead", referent_mm, velocity_mm_s, ...near });
  }

  push(force_cN: number, _at_ms: number): void {
    this.hand({ type: "push", force_cN });
  }

  lift(_at_ms: number): void {
    this.hand({ type: "lift" });
  }

  /** The hand leads nothing while nothing, or something else, comes under the finger. */
  private hand(ask: Ask): void {
    if (this.felt.peek() && !this.going.peek() && !this.paused.peek()) this.send(ask);
  }

  protected send(ask: Ask): boolean {
    return this.channel?.send(ask) ?? false;
  }

  private take(message: Tell): void {
    batch(() => this.taken(message));
    if (message.type === "felt") this.view?.onFelt();
    else if (message.type === "ready") this.view?.onReady(message);
    else if (message.type === "frame") this.view?.onFrame(message);
  }

  private taken(message: Tell): void {
    if (message.type === "frame") this.takeFrame(message);
    else if (message.type === "felt") {
      this.felt.set(message.label);
      // what is pressed on the table is reported by the device, not here
      if (this.onTable()) this.draft.peek()?.pressed(message.label);
      this.frame.set(null);
      this.going.set("");
    } else if (message.type === "ready") this.takeReady(message);
    else if (message.type === "broke") {
      this.away();
      this.send({ type: "again" });
    } else if (message.type === "step") this.takeStep(message);
    else this.takeSeated(message);
  }

  protected stepped(step: StudyStep): void {
    const task = step.task ?? null;
    // after a lost connection the same trial comes again: what was answered so far stays, what was felt does not
    if (this.draft.peek()?.task.number !== task?.number) this.draft.set(task && new Draft(task));
    else this.draft.peek()?.felt.set(new Set());
    if (task) this.send({ type: "shown", number: task.number });
  }

  private takeReady(ready: StudyReady): void {
    this.ready.set(ready);
    if (this.going.peek()) this.send({ type: "go", label: this.going.peek() });
  }

  private takeFrame(frame: StudyFrame): void {
    if (frame.label !== this.felt.peek() || this.going.peek()) return;
    this.frame.set(frame);
    if (frame.pressed > 0) this.draft.peek()?.pressed(frame.label);
  }

  /** Nothing is under the finger. */
  protected away(): void {
    this.ready.set(null);
    this.felt.set("");
    this.frame.set(null);
    this.going.set("");
  }

  protected override refused(line: string): void {
    this.going.set("");
    super.refused(line);
  }
}
