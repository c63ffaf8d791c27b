/** What is played: the strip, the button under test, and what is said between rounds. */

import { call } from "../../net";
import type { Offer } from "../../net/messages";
import { type StripView, stripView } from "../../play/strip";
import { type Signal, signal } from "../../ui";
import { Play, SIMULATED } from "./play";
import { named, type RunStore, scoreText } from "./store";

const SCORES = "fdvv-scores-shown";
const STRIP = { pixels: 144, zone_px: 100, zone_half_px: 5, speed_px_s: 100 } as const;

export class Board {
  readonly lights: StripView;
  readonly play: Play;
  /** Whether scores may be seen. */
  readonly scores: Signal<boolean> = signal(localStorage.getItem(SCORES) !== "no");
  /** The device that is pressed from the next trial on; SIMULATED if none is. */
  readonly device: Signal<string> = signal(SIMULATED);
  readonly devices: Signal<readonly Offer[]> = signal<readonly Offer[]>([]);
  /** Called when a trial was played and the run is known anew. */
  onFinished: () => void = () => undefined;
  private readonly last: Signal<number | null> = signal<number | null>(null);

  constructor(readonly store: RunStore) {
    const strip = () => store.detail()?.strip ?? STRIP;
    this.lights = stripView(strip);
    this.play = new Play({ strip, draw: this.lights.draw, finished: (trial) => this.finish(trial) });
    // without devices there is nothing to choose, whatever the reason
    call("optimize.devices", {}).then(
      (found) => this.devices.set(found.devices),
      () => undefined,
    );
  }

  /** Whether a trial is being played. */
  busy(): boolean {
    return this.play.standing() !== "away";
  }

  paused(): boolean {
    return this.play.game()?.phase === "pause";
  }

  /** Whether the budget is used up and nothing is under way. */
  spent(): boolean {
    return this.store.full() && !this.store.open() && !this.store.retesting();
  }

  /** What the button says that begins the next trial. */
  next(): string {
    const retest = this.store.detail()?.retest;
    if (retest && this.store.retesting()) return `Play again, blind: ${retest.done + 1} of ${retest.total}`;
    return `Play trial ${(this.store.openNumber() ?? this.store.detail()?.trials.length ?? 0) + 1}`;
  }

  /** Ask for the next design and put it under the finger. */
  async begin(): Promise<void> {
    const { trial } = await call("optimize.next", { run: this.store.run });
    this.last.set(null);
    this.play.open(this.store.run, trial, this.device.peek());
    this.play.clicker.wake();
  }

  abandon(trial: number): Promise<void> {
    return this.store.after(call("optimize.abandon", { run: this.store.run, trial }));
  }

  showScores(on: boolean): void {
    this.scores.set(on);
    localStorage.setItem(SCORES, on ? "yes" : "no");
  }

  /** What is said below the strip. */
  line(): string {
    const game = this.play.game();
    if (this.play.standing() === "opening") return "Loading the button …";
    if (game)
      return game.phase === "pause"
        ? `Paused after ${game.kept} of ${game.rounds} presses`
        : `Press ${Math.min(game.kept + 1, game.rounds)} of ${game.rounds}`;
    if (this.play.reason()) return this.play.reason();
    if (this.store.waiting() !== null) return "How was this button? The trial counts once you have answered.";
    const [last, spent] = [this.last(), this.spent()];
    if (last !== null)
      return `${this.scored(last)} ${spent ? "The run is over: see the result." : "Play the next one when you are ready."}`;
    if (spent) return "The run is over: see the result.";
    if (this.store.retesting()) return this.drawn();
    return "Press so that the key goes down as the bullet reaches the middle of the zone.";
  }

  private drawn(): string {
    const rivals = this.store.detail()?.retest.rivals.length ?? 0;
    const also = rivals ? `, and ${rivals} others` : "";
    return `The best design and your button${also} come in a drawn order.`;
  }

  private scored(number: number): string {
    const trial = this.store.detail()?.trials[number];
    const name = this.store.objective();
    const { label, unit } = named(name);
    if (trial?.state === "shown") return `Trial ${number + 1} is being scored.`;
    if (!trial) return "It is scored; which button it was is not shown.";
    if (!this.scores()) return `Trial ${number + 1} is done.`;
    return trial.state === "done"
      ? `Trial ${number + 1}: ${label} ${scoreText(trial.scores[name], unit)}.`
      : `Trial ${number + 1} failed: ${trial.reason}.`;
  }

  private finish(trial: number): void {
    this.last.set(trial);
    this.store.chosen.set(null);
    void this.store.refresh().then(() => this.onFinished());
  }
}
