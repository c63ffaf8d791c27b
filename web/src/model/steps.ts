/**
 * A line of steps with a place in it: unlimited undo and redo of any document whose edits are pure.
 *
 * A drag is three states, idle, marked, dragging: `mark` takes a snapshot, every `show` computes from that
 * snapshot, `release` makes one step of it and `cancel` goes back.
 */

/** Nudges of one kind that follow each other within this time are one step. */
export const NUDGE_s = 1;

/** How the changes of a document are kept. */
export interface Keeping<T, P> {
  /** Return what leads from one state to another; null if they are the same. */
  readonly between: (before: T, after: T) => P | null;
  readonly forward: (state: T, change: P) => T;
  readonly backward: (state: T, change: P) => T;
}

/** One step of undo: what people did, as changes in the order they were made. */
export interface StepOf<P> {
  readonly label: string;
  readonly patches: readonly P[];
  /** When the last of them was made, s since 1970. */
  readonly time_s: number;
}

/** What an edit did. */
export interface MadeOf<P> {
  readonly label: string;
  readonly patch: P;
  /** Whether it belongs to the step before it. */
  readonly joins: boolean;
}

/** When, and with what an edit may be coalesced. */
export interface When {
  readonly time_s: number;
  /** Edits of one kind, such as nudges of the same points, become one step within NUDGE_s. */
  readonly nudge?: string | undefined;
}

/** A document and everything that was done to it. */
export class StepLine<T, P> {
  #present: T;
  #steps: readonly StepOf<P>[];
  #done: number;
  #nudge: { readonly kind: string; readonly time_s: number } | null = null;
  #mark: { readonly state: T; label: string } | null = null;
  readonly #keeping: Keeping<T, P>;

  constructor(
    readonly opening: T,
    keeping: Keeping<T, P>,
    steps: readonly StepOf<P>[] = [],
    done = 0,
  ) {
    this.#keeping = keeping;
    this.#steps = steps;
    this.#done = done;
    this.#present = this.at(done);
  }

  /** The document as it is now, a drag under way included. */
  get present(): T {
    return this.#present;
  }

  /** The document as it is without a drag that is under way. */
  get settled(): T {
    return this.#mark ? this.#mark.state : this.#present;
  }

  /** All steps, done and undone. */
  get steps(): readonly StepOf<P>[] {
    return this.#steps;
  }

  /** How many of the steps are done. */
  get done(): number {
    return this.#done;
  }

  get canUndo(): boolean {
    return this.#done > 0;
  }

  get canRedo(): boolean {
    return this.#done < this.#steps.length;
  }

  /** What undo would take back; null if there is nothing. */
  get undoLabel(): string | null {
    return this.#steps[this.#done - 1]?.label ?? null;
  }

  /** What redo would do again; null if there is nothing. */
  get redoLabel(): string | null {
    return this.#steps[this.#done]?.label ?? null;
  }

  get dragging(): boolean {
    return this.#mark !== null;
  }

  /** Return the state after a number of steps; 0 is the opening. */
  at(done: number): T {
    return this.#steps.slice(0, done).reduce((state, step) => this.#forward(state, step), this.opening);
  }

  /** Make a state the present one, as one step; null if it is the same. */
  put(label: string, after: T, when: When): MadeOf<P> | null {
    this.cancel();
    return this.#push(label, after, when);
  }

  /** Begin a drag. */
  mark(label: string): void {
    this.cancel();
    this.#mark = { state: this.#present, label };
  }

  /** Show what a change of the marked state gives, or with a label of the present one; else nothing is done. */
  show(change: (marked: T) => T, label = this.#mark?.label): T {
    if (label === undefined) return this.#present;
    if (!this.#mark) this.mark(label);
    this.#present = change(this.#mark!.state);
    this.#mark!.label = label;
    return this.#present;
  }

  /** End a drag as one step; null if it changed nothing. */
  release(time_s: number): MadeOf<P> | null {
    if (!this.#mark) return null;
    const [{ label, state }, after] = [this.#mark, this.#present];
    this.#mark = null;
    this.#present = state;
    return this.#push(label, after, { time_s });
  }

  /** End a drag as if it had not been. */
  cancel(): void {
    if (!this.#mark) return;
    this.#present = this.#mark.state;
    this.#mark = null;
  }

  /** Go back by steps, as far as there are; tell how many. */
  undo(count = 1): number {
    this.#rest();
    const from = this.#done;
    for (let i = 0; i < count && this.canUndo; i++) {
      this.#done--;
      this.#present = this.#steps[this.#done]!.patches.reduceRight(this.#keeping.backward, this.#present);
    }
    return from - this.#done;
  }

  /** Go forward by steps that were undone, as far as there are; tell how many. */
  redo(count = 1): number {
    this.#rest();
    const from = this.#done;
    for (let i = 0; i < count && this.canRedo; i++) {
      this.#present = this.#forward(this.#present, this.#steps[this.#done]!);
      this.#done++;
    }
    return this.#done - from;
  }

  #forward(state: T, step: StepOf<P>): T {
    return step.patches.reduce(this.#keeping.forward, state);
  }

  #rest(): void {
    this.cancel();
    this.#nudge = null;
  }

  #push(label: string, after: T, when: When): MadeOf<P> | null {
    const patch = this.#keeping.between(this.#present, after);
    if (patch === null) return null;
    const joins = this.#joins(when);
    const before = this.#steps[this.#done - 1];
    const step = {
      label,
      patches: joins && before ? [...before.patches, patch] : [patch],
      time_s: when.time_s,
    };
    this.#steps = [...this.#steps.slice(0, this.#done - Number(joins)), step];
    this.#done = this.#steps.length;
    this.#present = after;
    this.#nudge = when.nudge === undefined ? null : { kind: when.nudge, time_s: when.time_s };
    return { label, patch, joins };
  }

  #joins({ nudge, time_s }: When): boolean {
    const last = this.#nudge;
    return last !== null && last.kind === nudge && !this.canRedo && time_s - last.time_s <= NUDGE_s;
  }
}
