/** One participant's screen: the channel to the study, and all that the page knows of it, as signals. */

import { type LiveChannel, live } from "../../net";
import type { Channels, StudyAbout, StudyFrame, StudyReady, StudyStep } from "../../net/messages";
import { batch, onCleanup, type Signal, signal } from "../../ui";
import type { FingerTarget } from "../press/finger_input";
import { Draft } from "./answer";
import { type Card, forget, holder, keepCard, keptCard } from "./keep";

type Tell = Channels["study"]["tells"];
type Ask = Channels["study"]["asks"];
/** look: nobody sits here. card: it is to be written down. step: as the step says. stopped: see reason. */
export type SessionStatus = "opening" | "look" | "card" | "step" | "stopped";

export interface StudyView {
  onReady(ready: StudyReady): void;
  onFelt(): void;
  onFrame(frame: StudyFrame): void;
}

const HERE_ms = 1000;

export class StudySession implements FingerTarget {
  readonly standing: Signal<SessionStatus> = signal<SessionStatus>("opening");
  readonly about: Signal<StudyAbout | null> = signal<StudyAbout | null>(null);
  readonly card: Signal<Card | null> = signal<Card | null>(null);
  readonly language: Signal<string> = signal("en");
  readonly step: Signal<StudyStep | null> = signal<StudyStep | null>(null);
  /** When the step arrived, on the page's clock. */
  toldAt_ms = 0;
  readonly draft: Signal<Draft | null> = signal<Draft | null>(null);
  /** What the trial's labels have in common, once they can be felt. */
  readonly ready: Signal<StudyReady | null> = signal<StudyReady | null>(null);
  /** What is under the finger, and what is being put there. */
  readonly felt: Signal<string> = signal("");
  readonly going: Signal<string> = signal("");
  readonly frame: Signal<StudyFrame | null> = signal<StudyFrame | null>(null);
  readonly lost: Signal<boolean> = signal(false);
  readonly paused: Signal<boolean> = signal(false);
  /** What was sent waits for its answer. */
  readonly waiting: Signal<boolean> = signal(false);
  readonly reason: Signal<string> = signal("");
  /** The trial that is shown: it hears of what it feels at once. */
  view: StudyView | null = null;
  private channel: LiveChannel<"study"> | null = null;

  constructor(
    readonly study: string,
    readonly seat: string,
  ) {
    this.card.set(keptCard(study, seat));
    this.language.set(this.card.peek()?.language ?? "en");
    this.channel = live().channel("study", {
      onMessage: (message) => this.take(message),
      wrong: (line) => this.refused(line),
      opened: () => this.channel && this.opened(),
      lost: () => this.left(),
    });
    if (live().state.peek() === "open") this.opened();
    const timer = setInterval(
      () => !document.hidden && this.standing.peek() === "step" && this.send({ type: "here" }),
      HERE_ms,
    );
    onCleanup(() => {
      clearInterval(timer);
      this.channel?.close();
    });
  }

  sit(): void {
    this.ask({
      type: "sit",
      study: this.study,
      seat: this.seat,
      holder: holder(this.study, this.seat),
      language: this.language.peek(),
    });
  }

  /** Go on with what stands on a card. */
  resume(person: string, code: string): void {
    this.card.set({ person, code, language: this.language.peek(), noted: true });
    this.ask({ type: "resume", study: this.study, person, code });
  }

  noted(): void {
    const card = this.card.peek();
    if (card) this.keep({ ...card, noted: true });
    this.standing.set(this.step.peek() ? "step" : "opening");
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
    this.ask({
      type: "answer",
      number: draft.task.number,
      choice: draft.choice.peek(),
      ratings: draft.ratings.peek(),
    });
  }

  fill(values: Readonly<Record<string, string | number>>, agreed: boolean): void {
    const name = this.step.peek()?.form?.name;
    if (name !== undefined) this.ask({ type: "page", name, values, agreed });
  }

  rested(): void {
    this.ask({ type: "rested" });
  }

  withdraw(): void {
    this.ask({ type: "withdraw" });
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

  private send(ask: Ask): boolean {
    return this.channel?.send(ask) ?? false;
  }

  /** Send what will be answered. */
  private ask(ask: Ask): void {
    this.reason.set("");
    if (this.send(ask)) this.waiting.set(true);
  }

  private left(): void {
    batch(() => {
      this.lost.set(true);
      // the server says it again where the study still is
      this.paused.set(false);
    });
  }

  private opened(): void {
    const card = this.card.peek();
    batch(() => {
      this.waiting.set(false);
      this.away();
    });
    if (card) this.send({ type: "resume", study: this.study, person: card.person, code: card.code });
    else
      this.send({ type: "look", study: this.study, seat: this.seat, holder: holder(this.study, this.seat) });
  }

  private take(message: Tell): void {
    batch(() => this.taken(message));
    if (message.type === "felt") this.view?.onFelt();
    else if (message.type === "ready") this.view?.onReady(message);
    else if (message.type === "frame") this.view?.onFrame(message);
  }

  private taken(message: Tell): void {
    // the connection is back before the study is: what is pressed between them would be lost
    if (message.type === "step" || message.type === "about" || message.type === "stopped")
      this.lost.set(false);
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
    else if (message.type === "about") this.takeAbout(message);
    else if (message.type === "card") this.takeCard(message);
    else if (message.type === "paused") this.paused.set(message.on);
    else this.stop(message.reason);
  }

  private takeAbout(about: StudyAbout): void {
    this.about.set(about);
    const own = navigator.languages
      .map((language) => language.split("-")[0] ?? language)
      .find((one) => about.languages.includes(one));
    this.language.set(own ?? about.languages[0] ?? "en");
    this.standing.set("look");
  }

  private takeCard(message: {
    readonly person: string;
    readonly language: string;
    readonly code: string;
  }): void {
    const known = this.card.peek();
    this.language.set(message.language);
    this.keep({
      person: message.person,
      code: message.code || (known?.code ?? ""),
      language: message.language,
      noted: !message.code && (known?.noted ?? true),
    });
  }

  private takeStep(step: StudyStep): void {
    const task = step.task ?? null;
    this.toldAt_ms = performance.now();
    this.waiting.set(false);
    this.reason.set("");
    this.away();
    // after a lost connection the same trial comes again: what was answered so far stays, what was felt does not
    if (this.draft.peek()?.task.number !== task?.number) this.draft.set(task && new Draft(task));
    else this.draft.peek()?.felt.set(new Set());
    this.step.set(step);
    this.standing.set(this.card.peek()?.noted === false ? "card" : "step");
    if (task) this.send({ type: "shown", number: task.number });
    if (step.kind === "withdrawn" || step.kind === "declined" || step.kind === "done")
      forget(this.study, this.seat);
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
  private away(): void {
    this.ready.set(null);
    this.felt.set("");
    this.frame.set(null);
    this.going.set("");
  }

  private keep(card: Card): void {
    this.card.set(card);
    keepCard(this.study, this.seat, card);
  }

  /** The server said no to something: nobody sits here yet, or the screen goes on as it is. */
  private refused(line: string): void {
    batch(() => {
      this.lost.set(false);
      this.waiting.set(false);
      this.going.set("");
      this.reason.set(line);
    });
    if (this.standing.peek() === "step") return;
    this.card.set(null);
    keepCard(this.study, this.seat, null);
    if (!this.about.peek())
      this.send({ type: "look", study: this.study, seat: this.seat, holder: holder(this.study, this.seat) });
  }

  private stop(reason: string): void {
    this.reason.set(reason);
    this.standing.set("stopped");
  }
}
