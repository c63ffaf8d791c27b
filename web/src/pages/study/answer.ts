/** What is being answered in one trial: free to change until it is sent. */

import type { StudyTask } from "../../net/messages";
import { type Signal, signal } from "../../ui";

export const EQUAL = "equal";
/** A scale of more points is a slider. */
export const MOST_BUTTONS = 11;

export class Draft {
  readonly choice: Signal<string> = signal("");
  /** By scale, then by label. */
  readonly ratings: Signal<Readonly<Record<string, Readonly<Record<string, number>>>>> = signal({});
  /** Labels that were pressed. */
  readonly felt: Signal<ReadonlySet<string>> = signal<ReadonlySet<string>>(new Set());

  constructor(readonly task: StudyTask) {}

  rate(scale: string, label: string, points: number): void {
    this.ratings.update((now) => ({ ...now, [scale]: { ...now[scale], [label]: points } }));
  }

  /** Rate what is under the finger on the first scale that lacks it, else on the last. False if it is not rated so. */
  rateFelt(label: string, points: number): boolean {
    if (!this.task.rated.includes(label)) return false;
    const scales = this.task.scales.filter((scale) => scale.points <= MOST_BUTTONS);
    const scale =
      scales.find((scale) => this.ratings.peek()[scale.name]?.[label] === undefined) ?? scales.at(-1);
    if (!scale || points < 1 || points > scale.points) return false;
    this.rate(scale.name, label, points);
    return true;
  }

  /** Choose; False if that is not offered. */
  choose(choice: string): boolean {
    if (choice === EQUAL ? !this.task.equal : !this.task.choices.includes(choice)) return false;
    this.choice.set(choice);
    return true;
  }

  pressed(label: string): void {
    if (!this.felt.peek().has(label)) this.felt.update((now) => new Set([...now, label]));
  }

  /** Labels that were not pressed yet. */
  unfelt(): readonly string[] {
    return this.task.places.filter((label) => !this.felt().has(label));
  }

  /** Whether all that is asked is answered. */
  complete(): boolean {
    const { task } = this;
    const chosen = !task.choices.length || this.choice() !== "";
    const rated = task.scales.every((scale) =>
      task.rated.every((label) => this.ratings()[scale.name]?.[label] !== undefined),
    );
    return chosen && rated && !this.unfelt().length;
  }
}
