/** Who sits at a participant's screen, whatever the study asks of them: seat, card, language, pause, way out. */

import type {
  EndBreak,
  Here,
  JoinSession,
  StudyAbout,
  StudyBroke,
  StudyCard,
  StudyFilled,
  StudyForm,
  StudyLook,
  StudyPaused,
  StudyResume,
  StudyStopped,
  StudyWithdraw,
} from "../../net/messages";
import { batch, onCleanup, type Signal, signal } from "../../ui";
import { type Card, forget, holder, keepCard, keptCard } from "./keep";

/** look: nobody sits here. card: it is to be written down. step: as the step says. stopped: see reason. */
export type SessionStatus = "opening" | "look" | "card" | "step" | "stopped";
export type SeatedAsk = StudyLook | JoinSession | StudyResume | StudyFilled | EndBreak | StudyWithdraw | Here;
export type SeatedTell = StudyAbout | StudyCard | StudyBroke | StudyPaused | StudyStopped;

/** What every step has, of whatever study. */
export interface SeatedStep {
  readonly kind: string;
  readonly progress_ratio: number;
  readonly form?: StudyForm | null;
  readonly left_s?: number | null;
}

const HERE_ms = 1000;
/** Kinds of the steps at which the study is over for who sits here. */
export const OVER: readonly string[] = ["done", "declined", "withdrawn"];

export abstract class SeatedSession<S extends SeatedStep = SeatedStep> {
  readonly standing: Signal<SessionStatus> = signal<SessionStatus>("opening");
  readonly about: Signal<StudyAbout | null> = signal<StudyAbout | null>(null);
  readonly card: Signal<Card | null> = signal<Card | null>(null);
  readonly language: Signal<string> = signal("en");
  readonly step: Signal<S | null> = signal<S | null>(null);
  /** When the step arrived, on the page's clock. */
  toldAt_ms = 0;
  readonly lost: Signal<boolean> = signal(false);
  readonly paused: Signal<boolean> = signal(false);
  /** What was sent waits for its answer. */
  readonly waiting: Signal<boolean> = signal(false);
  readonly reason: Signal<string> = signal("");

  constructor(
    readonly study: string,
    readonly seat: string,
  ) {
    this.card.set(keptCard(study, seat));
    this.language.set(this.card.peek()?.language ?? "en");
    const timer = setInterval(
      () => !document.hidden && this.standing.peek() === "step" && this.send({ type: "here" }),
      HERE_ms,
    );
    onCleanup(() => clearInterval(timer));
  }

  /** Send; false where there is no connection. */
  protected abstract send(ask: SeatedAsk): boolean;
  /** Nothing is under the finger any more. */
  protected abstract away(): void;
  /** A step has come: what belongs to its trial is taken up. */
  protected abstract stepped(step: S): void;

  /** Whether something lies over the screen, so that nothing can be done. */
  covered(): boolean {
    return this.lost() || this.paused();
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

  /** Send what will be answered. */
  protected ask(ask: SeatedAsk): void {
    this.expect(() => this.send(ask));
  }

  /** Wait for the answer to what is sent. */
  protected expect(sent: () => boolean): void {
    this.reason.set("");
    if (sent()) this.waiting.set(true);
  }

  protected left(): void {
    batch(() => {
      this.lost.set(true);
      // the server says it again where the study still is
      this.paused.set(false);
    });
  }

  protected opened(): void {
    const card = this.card.peek();
    batch(() => {
      this.waiting.set(false);
      this.away();
    });
    if (card) this.send({ type: "resume", study: this.study, person: card.person, code: card.code });
    else this.look();
  }

  /** Take what every study tells; what a button does is for the others. */
  protected takeSeated(message: Exclude<SeatedTell, StudyBroke>): void {
    // the connection is back before the study is: what is pressed between them would be lost
    if (message.type === "about" || message.type === "stopped") this.lost.set(false);
    if (message.type === "about") this.takeAbout(message);
    else if (message.type === "card") this.takeCard(message);
    else if (message.type === "paused") this.paused.set(message.on);
    else this.stop(message.reason);
  }

  protected takeStep(step: S): void {
    this.lost.set(false);
    this.toldAt_ms = performance.now();
    this.waiting.set(false);
    this.reason.set("");
    this.away();
    this.step.set(step);
    this.standing.set(this.card.peek()?.noted === false ? "card" : "step");
    this.stepped(step);
    if (OVER.includes(step.kind)) forget(this.study, this.seat);
  }

  /** The server said no to something: nobody sits here yet, or the screen goes on as it is. */
  protected refused(line: string): void {
    batch(() => {
      this.lost.set(false);
      this.waiting.set(false);
      this.reason.set(line);
    });
    if (this.standing.peek() === "step") return;
    this.card.set(null);
    keepCard(this.study, this.seat, null);
    if (!this.about.peek()) this.look();
  }

  private look(): void {
    this.send({ type: "look", study: this.study, seat: this.seat, holder: holder(this.study, this.seat) });
  }

  private takeAbout(about: StudyAbout): void {
    this.about.set(about);
    const own = navigator.languages
      .map((language) => language.split("-")[0] ?? language)
      .find((one) => about.languages.includes(one));
    this.language.set(own ?? about.languages[0] ?? "en");
    this.standing.set("look");
  }

  private takeCard(message: StudyCard): void {
    const known = this.card.peek();
    this.language.set(message.language);
    this.keep({
      person: message.person,
      code: message.code || (known?.code ?? ""),
      language: message.language,
      noted: !message.code && (known?.noted ?? true),
    });
  }

  private keep(card: Card): void {
    this.card.set(card);
    keepCard(this.study, this.seat, card);
  }

  private stop(reason: string): void {
    this.reason.set(reason);
    this.standing.set("stopped");
  }
}
