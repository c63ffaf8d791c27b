/** The history of a model: steps of patches, so that they can be sent and kept, and states pinned to compare with. */

import { applyEdit, type Edit } from "./edit";
import { same } from "./model";
import { applyPatch, diff, invert, isEmpty, type Patch } from "./patch";
import { type Keeping, type MadeOf, StepLine, type StepOf, type When } from "./steps";
import type { FDVVModel } from "./types";

export type Step = StepOf<Patch>;
export type Made = MadeOf<Patch>;

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

const PATCHES: Keeping<FDVVModel, Patch> = {
  between: (before, after) => {
    const patch = diff(before, after);
    return isEmpty(patch) ? null : patch;
  },
  forward: (model, patch) => applyPatch(model, patch),
  backward: (model, patch) => applyPatch(model, invert(patch)),
};

/** The model and everything that was done to it. */
export class History extends StepLine<FDVVModel, Patch> {
  #pins: readonly Pin[];

  constructor(opening: FDVVModel, kept?: Omit<HistoryRecord, "opening">) {
    super(opening, PATCHES, kept?.steps, kept?.done);
    this.#pins = kept?.pins ?? [];
  }

  static fromJSON({ opening, ...kept }: HistoryRecord): History {
    return new History(opening, kept);
  }

  toJSON(): HistoryRecord {
    return { opening: this.opening, steps: this.steps, done: this.done, pins: this.#pins };
  }

  /** The model as it is now, a drag under way included. */
  get model(): FDVVModel {
    return this.present;
  }

  /** Do an edit as one step; null if it changed nothing. Throws ModelError, and then nothing has changed. */
  apply(edit: Edit, when: When): Made | null {
    this.cancel();
    return this.put(edit.label, applyEdit(this.present, edit), when);
  }

  /** Show what an edit of the marked state would give; one that is refused leaves what was shown. */
  drag(edit: Edit): FDVVModel {
    return this.show((marked) => applyEdit(marked, edit), edit.label);
  }

  /** States that were pinned. */
  get pins(): readonly Pin[] {
    return this.#pins;
  }

  /** Keep the present state to compare with. */
  pin(label: string): Pin {
    const pin = { label, model: this.settled };
    this.#pins = [...this.#pins, pin];
    return pin;
  }

  unpin(index: number): void {
    this.#pins = this.#pins.filter((_, i) => i !== index);
  }

  /** Whether the model differs from that at opening. */
  get changed(): boolean {
    return !same(this.model, this.opening);
  }
}
