/**
 * The history of a document: a line of steps with a place in it, unlimited undo and redo.
 *
 * A drag is three states, idle, marked, dragging: `mark` takes a snapshot, every `drag` computes from that
 * snapshot, `release` makes one step of it and `cancel` goes back. Steps are patches, so that they can be sent
 * and kept.
 */

import { applyEdit, type Edit } from "./edit";
import { same } from "./model";
import { applyPatch, diff, invert, isEmpty, type Patch } from "./patch";
import type { FDVVModel } from "./types";

/** Nudges of one kind that follow each other within this time are one step. */
export const NUDGE_s = 1;

/** One step of undo: what people did, as patches in the order they were made. */
export interface Step {
  readonly label: string;
  readonly patches: readonly Patch[];
  /** When the last of them was made, s since 1970. */
  readonly time_s: number;
}

/** A state that a designer wants to compare with. */
export interface Pin {
  readonly label: string;
  readonly model: FDVVModel;
}

/** A history as it is kept. */
export interface HistoryRecord {
  readonly opening: FDVVModel;
  readonly steps: readonly Step[];
  /** How many of the steps are done; those behind can be redone. */
  readonly done: number;
  readonly pins: readonly Pin[];
}

/** What an edit did. */
export interface Made {
  readonly label: string;
  readonly patch: Patch;
  /** Whether it belongs to the step before it. */
  readonly joins: boolean;
}

/** When, and with what an edit may be coalesced. */
export interface When {
  readonly time_s: number;
  /** Edits of one kind, such as nudges of the same points, become one step within NUDGE_s. */
  readonly nudge?: string;
}

/** The model and everything that was done to it. */
export class History {
  #model: FDVVModel;
  #steps: Step[];
  #done: number;
  #pins: Pin[];
  readonly opening: FDVVModel;
  #nudge: { readonly kind: string; readonly time_s: number } | null = null;
  #mark: { readonly model: FDVVModel; label: string } | null = null;

  constructor(opening: FDVVModel, kept?: Omit<HistoryRecord, "opening">) {
    this.opening = opening;
    this.#steps = [...(kept?.steps ?? [])];
    this.#done = kept?.done ?? 0;
    this.#pins = [...(kept?.pins ?? [])];
    this.#model = this.#steps.slice(0, this.#done).reduce(forward, opening);
  }

  static fromJSON({ opening, ...kept }: HistoryRecord): History {
    return new History(opening, kept);
  }

  toJSON(): HistoryRecord {
    return { opening: this.opening, steps: this.#steps, done: this.#done, pins: this.#pins };
  }

  /** The model as it is now, a drag under way included. */
  get model(): FDVVModel {
    return this.#model;
  }

  /** All steps, done and undone. */
  get steps(): readonly Step[] {
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

  /** Do an edit as one step; null if it changed nothing. Throws ModelError, and then nothing has changed. */
  apply(edit: Edit, when: When): Made | null {
    this.cancel();
    return this.#push(edit.label, applyEdit(this.#model, edit), when);
  }

  /** Begin a drag. */
  mark(label: string): void {
    this.cancel();
    this.#mark = { model: this.#model, label };
  }

  /** Show what an edit of the marked state would give; one that is refused leaves what was shown. */
  drag(edit: Edit): FDVVModel {
    if (!this.#mark) this.mark(edit.label);
    this.#model = applyEdit(this.#mark!.model, edit);
    this.#mark!.label = edit.label;
    return this.#model;
  }

  /** End a drag as one step; null if it changed nothing. */
  release(time_s: number): Made | null {
    if (!this.#mark) return null;
    const [{ label, model: before }, after] = [this.#mark, this.#model];
    this.#mark = null;
    this.#model = before;
    return this.#push(label, after, { time_s });
  }

  /** End a drag as if it had not been. */
  cancel(): void {
    if (!this.#mark) return;
    this.#model = this.#mark.model;
    this.#mark = null;
  }

  /** Go back by steps, as far as there are; tell how many. */
  undo(count = 1): number {
    this.#settle();
    const from = this.#done;
    for (let i = 0; i < count && this.canUndo; i++) {
      this.#done--;
      this.#model = backward(this.#model, this.#steps[this.#done]!);
    }
    return from - this.#done;
  }

  /** Go forward by steps that were undone, as far as there are; tell how many. */
  redo(count = 1): number {
    this.#settle();
    const from = this.#done;
    for (let i = 0; i < count && this.canRedo; i++) {
      this.#model = forward(this.#model, this.#steps[this.#done]!);
      this.#done++;
    }
    return this.#done - from;
  }

  /** States that were pinned. */
  get pins(): readonly Pin[] {
    return this.#pins;
  }

  /** Keep the present state to compare with. */
  pin(label: string): Pin {
    const pin = { label, model: this.#mark?.model ?? this.#model };
    this.#pins = [...this.#pins, pin];
    return pin;
  }

  unpin(index: number): void {
    this.#pins = this.#pins.filter((_, i) => i !== index);
  }

  /** Give the state after a number of steps; 0 is the opening. */
  at(done: number): FDVVModel {
    return this.#steps.slice(0, done).reduce(forward, this.opening);
  }

  /** Whether the model differs from that at opening. */
  get changed(): boolean {
    return !same(this.#model, this.opening);
  }

  #settle(): void {
    this.cancel();
    this.#nudge = null;
  }

  #push(label: string, after: FDVVModel, when: When): Made | null {
    const patch = diff(this.#model, after);
    if (isEmpty(patch)) return null;
    const joins = this.#joins(when);
    const before = this.#steps[this.#done - 1];
    const step = { label, patches: joins && before ? [...before.patches, patch] : [patch], time_s: when.time_s };
    this.#steps = [...this.#steps.slice(0, this.#done - Number(joins)), step];
    this.#done = this.#steps.length;
    this.#model = after;
    this.#nudge = when.nudge === undefined ? null : { kind: when.nudge, time_s: when.time_s };
    return { label, patch, joins };
  }

  #joins({ nudge, time_s }: When): boolean {
    const last = this.#nudge;
    return last !== null && last.kind === nudge && !this.canRedo && time_s - last.time_s <= NUDGE_s;
  }
}

function forward(model: FDVVModel, step: Step): FDVVModel {
  return step.patches.reduce(applyPatch, model);
}

function backward(model: FDVVModel, step: Step): FDVVModel {
  return step.patches.reduceRight((now, patch) => applyPatch(now, invert(patch)), model);
}
