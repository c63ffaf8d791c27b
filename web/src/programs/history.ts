/** Undo and redo of a document whose edits are pure: the states themselves are kept, for they share their parts. */

/** Nudges of one kind that follow each other within this time are one step. */
export const NUDGE_ms = 1000;

interface Step<T> {
  readonly label: string;
  readonly before: T;
  readonly after: T;
  readonly nudge: string | null;
  readonly time_ms: number;
}

/**
 * A document and what was done to it.
 *
 * A drag is `mark`, any number of `drag`, then `release`, which makes one step of it, or `cancel`.
 */
export class History<T> {
  private steps: readonly Step<T>[] = [];
  private done = 0;
  private marked: { readonly before: T; readonly label: string } | null = null;

  constructor(
    private held: T,
    private readonly now_ms: () => number = Date.now,
  ) {}

  /** The document as it is now, a drag under way included. */
  get present(): T {
    return this.held;
  }

  get dragging(): boolean {
    return this.marked !== null;
  }

  /** What undo would take back; null if there is nothing. */
  get undoLabel(): string | null {
    return this.steps[this.done - 1]?.label ?? null;
  }

  /** What redo would do again; null if there is nothing. */
  get redoLabel(): string | null {
    return this.steps[this.done]?.label ?? null;
  }

  /** Do an edit as one step; nothing if the document is the same. Nudges of one kind join. */
  apply(label: string, after: T, nudge: string | null = null): void {
    this.cancel();
    if (after === this.held) return;
    const last = this.steps[this.done - 1];
    const time_ms = this.now_ms();
    const joins =
      nudge !== null && last?.nudge === nudge && this.done === this.steps.length && time_ms - last.time_ms <= NUDGE_ms;
    const step = { label, before: joins ? last.before : this.held, after, nudge, time_ms };
    this.steps = [...this.steps.slice(0, joins ? this.done - 1 : this.done), step];
    this.done = this.steps.length;
    this.held = after;
  }

  /** Begin a drag. */
  mark(label: string): void {
    this.cancel();
    this.marked = { before: this.held, label };
  }

  /** Show what a change of the marked document gives. */
  drag(change: (before: T) => T): void {
    if (this.marked) this.held = change(this.marked.before);
  }

  /** End a drag as one step. */
  release(): void {
    if (!this.marked) return;
    const { before, label } = this.marked;
    const after = this.held;
    this.held = before;
    this.marked = null;
    this.apply(label, after);
  }

  /** End a drag as if it had not been. */
  cancel(): void {
    if (!this.marked) return;
    this.held = this.marked.before;
    this.marked = null;
  }

  /** Go back one step; nothing at the beginning. */
  undo(): void {
    this.cancel();
    const step = this.steps[this.done - 1];
    if (!step) return;
    this.done -= 1;
    this.held = step.before;
  }

  /** Do again what was undone last; nothing at the end. */
  redo(): void {
    this.cancel();
    const step = this.steps[this.done];
    if (!step) return;
    this.done += 1;
    this.held = step.after;
  }
}
