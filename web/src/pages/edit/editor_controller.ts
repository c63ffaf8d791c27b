/** The state of the editor: the button that is edited, and what of it is shown. */

import { type Constraints, type Landmarks, landmarks, ModelError } from "../../math";
import {
  type CurveRef,
  curveAt,
  type DocumentStore,
  type Edit,
  type FDVVModel,
  type ForceCurve,
  isAt,
  type SaveState,
} from "../../model";
import { within } from "../../tools/selection";
import { batch, computed, onCleanup, type Signal, signal, tell } from "../../ui";
import { velocitiesOf } from "./look";

/** A part of the travel that was chosen. */
export interface Span {
  readonly from_mm: number;
  readonly to_mm: number;
}

/** The state of the page; every signal can be followed by any part of it. */
export class EditorController {
  /** The button as it is seen, a drag under way included. */
  readonly model: Signal<FDVVModel>;
  /** The button after the last finished step. */
  readonly settled: Signal<FDVVModel>;
  readonly active: Signal<CurveRef>;
  readonly selection: Signal<readonly number[]> = signal<readonly number[]>([]);
  readonly span: Signal<Span | null> = signal<Span | null>(null);
  readonly constraints: Signal<Constraints> = signal<Constraints>({});
  /** A drag moves every speed of the stroke, not only the active curve. */
  readonly everySpeed: Signal<boolean> = signal(false);
  /** What the present is compared with. */
  readonly before: Signal<FDVVModel>;
  readonly showBefore = signal(true);
  /** Why a move goes no further; empty while it does. */
  readonly refusal = signal("");
  /** Counts the changes of the history and of what is saved of it. */
  readonly turns = signal(0);
  readonly saved: Signal<SaveState>;
  readonly curve: () => ForceCurve;
  readonly others: () => readonly ForceCurve[];
  readonly velocities: () => readonly (number | null)[];
  readonly landmarks: () => Landmarks | null;

  constructor(readonly store: DocumentStore) {
    const model = store.model;
    this.model = signal(model);
    this.settled = signal(model);
    this.before = signal(store.pins.at(-1)?.model ?? store.history.opening);
    this.saved = signal(store.state);
    this.active = signal(refOf(model.curves[0]!));
    this.curve = computed(() => curveAt(this.model(), this.active()) ?? this.model().curves[0]!);
    this.others = steady(() => this.model().curves.filter((curve) => !isAt(curve, this.active())));
    this.velocities = steady(() => velocitiesOf(this.model()));
    this.landmarks = computed(() => landmarksOf(this.model(), this.active()));
    onCleanup(store.onChange(() => this.follow()));
  }

  /** Do an edit as one step; return false, and show why, if it is refused. */
  apply(edit: Edit, nudge?: string): boolean {
    try {
      this.store.apply(edit, nudge);
      return true;
    } catch (error) {
      tell(error);
      return false;
    }
  }

  /** The curves that follow a drag of the active one, as they are before it. */
  followers(): readonly ForceCurve[] {
    if (!this.everySpeed()) return [];
    const at = this.active();
    return this.settled().curves.filter((curve) => curve.stroke === at.stroke && !isAt(curve, at));
  }

  /** Begin a drag. */
  mark(label: string): void {
    this.store.mark(label);
  }

  /** Show what an edit of the marked state gives; where it is refused the last one stays, and why is said. */
  drag(edit: Edit): void {
    try {
      this.store.drag(edit);
      this.refusal.set("");
    } catch (error) {
      if (!(error instanceof ModelError)) throw error;
      this.refusal.set(error.message);
    }
  }

  /** End a drag as one step. */
  release(): void {
    this.store.release();
    this.refusal.set("");
  }

  /** End a drag as if it had not been. */
  cancel(): void {
    this.store.cancel();
    this.refusal.set("");
  }

  /** Go back or forward by steps. */
  step(by: number): void {
    if (by < 0) this.store.undo(-by);
    else this.store.redo(by);
    this.follow();
  }

  /** After a conflict or a refusal: go on with what the server has. */
  takeTheirs(): void {
    this.store.takeTheirs().then(() => this.follow(), tell);
  }

  /** Make a curve the active one. */
  activate(at: CurveRef): void {
    if (isAt(at, this.active.peek())) return;
    batch(() => {
      this.active.set(refOf(at));
      this.selection.set([]);
    });
  }

  /** Show the store's model, and hold on to what is still there of what was looked at. */
  follow(): void {
    const { model, history } = this.store;
    batch(() => {
      this.model.set(model);
      this.saved.set(this.store.state);
      if (history.dragging) return;
      this.settled.set(model);
      this.turns.update((n) => n + 1);
      if (!curveAt(model, this.active.peek())) this.active.set(refOf(nearestTo(model, this.active.peek())));
      const count = curveAt(model, this.active.peek())!.control_points_cN.length;
      const left = within(this.selection.peek(), count);
      if (left.length !== this.selection.peek().length) this.selection.set(left);
    });
  }
}

/** The stroke and velocity of a part. */
export function refOf({ stroke, velocity_mm_s }: CurveRef): CurveRef {
  return { stroke, velocity_mm_s };
}

function nearestTo(model: FDVVModel, at: CurveRef): ForceCurve {
  const off = (c: CurveRef) =>
    Math.abs((c.velocity_mm_s ?? 0) - (at.velocity_mm_s ?? 0)) + (c.stroke === at.stroke ? 0 : 1e6);
  return [...model.curves].sort((a, b) => off(a) - off(b))[0]!;
}

function landmarksOf(model: FDVVModel, at: CurveRef): Landmarks | null {
  return model.curves.some((c) => c.stroke === "press") ? landmarks(model, at.velocity_mm_s) : null;
}

/** A computed list that stays the same list as long as its members do: who follows it need not run. */
function steady<T>(work: () => readonly T[]): () => readonly T[] {
  let last: readonly T[] = [];
  return computed(() => {
    const now = work();
    if (now.length !== last.length || now.some((one, i) => one !== last[i])) last = now;
    return last;
  });
}
