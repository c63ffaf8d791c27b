/** An open program: its history, what is chosen in it, what the check says of it, and its way to the server. */

import { lineOf } from "../../math/words";
import type { ProgramCheck, ProgramFinding, ProgramText } from "../../net/messages";
import { type ProgramDocument, readDocument, writeDocument } from "../../programs/document";
import { historyOf, type ProgramHistory } from "../../programs/history";
import { type Choice, isThere, WHOLE } from "../../programs/path";
import { problemsOf } from "../../programs/problems";
import { batch, computed, type Signal, signal } from "../../ui/signal.svelte";

/** What a book needs of a server; all reject with one line for the person. */
export interface ProgramServer {
  check(text: string): Promise<ProgramCheck>;
  save(program: string, text: string, revision: string): Promise<ProgramText>;
}

/**
 * saved: the file is what is shown. waiting: it will be written. saving: it is being written.
 * scratch: a shipped program, whose changes live on this page alone. refused: it cannot be written, as `line` tells.
 */
export interface SaveState {
  readonly kind: "saved" | "waiting" | "saving" | "scratch" | "refused";
  readonly line: string;
}

export const CHECK_AFTER_ms = 200;
export const SAVE_AFTER_ms = 700;

/** One program while it is open. */
export class ProgramBook {
  readonly id: string;
  readonly document: Signal<ProgramDocument>;
  readonly choice: Signal<Choice> = signal<Choice>(WHOLE);
  readonly check: Signal<ProgramCheck | null> = signal<ProgramCheck | null>(null);
  readonly checking: Signal<boolean> = signal(false);
  readonly saved: Signal<SaveState>;
  readonly undoLabel: Signal<string | null> = signal<string | null>(null);
  readonly redoLabel: Signal<string | null> = signal<string | null>(null);
  /** What is wrong: at once what the page can tell, else what the check found. */
  readonly findings: () => readonly ProgramFinding[];
  private readonly history: ProgramHistory;
  private revision: string;
  private checkTimer: ReturnType<typeof setTimeout> | undefined;
  private saveTimer: ReturnType<typeof setTimeout> | undefined;
  private turn = 0;
  private writing = false;
  /** The document that was last checked and saved, or is about to be: a drag shows others before it ends. */
  private handled: ProgramDocument;

  constructor(
    private readonly server: ProgramServer,
    opened: ProgramText,
  ) {
    this.id = opened.program;
    this.revision = opened.revision;
    const document = readDocument(opened.text);
    this.history = historyOf(document);
    this.document = signal(document);
    this.handled = document;
    this.saved = signal(this.settled);
    this.findings = computed(() => localFindings(this.document()) ?? this.check()?.findings ?? []);
    void this.runCheck();
  }

  /** Whether the program is one of the person's, and written as it is edited. */
  get own(): boolean {
    return this.id.startsWith("own:");
  }

  /** The text as it is now. */
  get text(): string {
    return writeDocument(this.document.peek());
  }

  /** Do an edit as one step of undo; edits of one `nudge` that follow each other are one. */
  edit(label: string, change: (document: ProgramDocument) => ProgramDocument, nudge?: string): void {
    this.history.put(label, change(this.history.settled), { time_s: now_s(), nudge });
    this.changed();
  }

  /** Do an edit and choose what it made, or gave a new name. */
  make(label: string, change: (document: ProgramDocument) => ProgramDocument, choice: Choice): void {
    batch(() => {
      this.edit(label, change);
      this.choice.set(choice);
    });
  }

  /** Choose what is looked at. */
  choose(choice: Choice): void {
    this.choice.set(choice);
  }

  /** Begin a drag. */
  mark(label: string): void {
    this.history.mark(label);
  }

  /** Show what a drag gives so far, computed from the document at its start. */
  drag(change: (before: ProgramDocument) => ProgramDocument): void {
    this.document.set(this.history.show(change));
  }

  /** End a drag as one step. */
  release(): void {
    this.history.release(now_s());
    this.changed();
  }

  /** End a drag as if it had not been. */
  cancel(): void {
    this.history.cancel();
    this.document.set(this.history.present);
  }

  undo(): void {
    this.history.undo();
    this.changed();
  }

  redo(): void {
    this.history.redo();
    this.changed();
  }

  /** Write now what waits to be written; again after it was refused. */
  async save(): Promise<void> {
    clearTimeout(this.saveTimer);
    if (!this.own || this.writing || this.saved.peek().kind === "saved") return;
    this.writing = true;
    const sent = this.document.peek();
    this.saved.set({ kind: "saving", line: "" });
    try {
      this.revision = (await this.server.save(this.id, writeDocument(sent), this.revision)).revision;
      this.saved.set(this.settled);
    } catch (error) {
      this.saved.set({ kind: "refused", line: lineOf(error) });
    }
    this.writing = false;
    if (this.document.peek() !== sent) this.saveSoon();
  }

  /** Stop checking, and write what is unsaved now; settled when that is done. */
  async close(): Promise<void> {
    clearTimeout(this.checkTimer);
    this.turn += 1;
    await this.save();
  }

  private get settled(): SaveState {
    return { kind: this.own ? "saved" : "scratch", line: "" };
  }

  private changed(): void {
    const document = this.history.present;
    this.undoLabel.set(this.history.undoLabel);
    this.redoLabel.set(this.history.redoLabel);
    this.document.set(document);
    if (document === this.handled) return;
    this.handled = document;
    if (!isThere(document, this.choice.peek())) this.choice.set(WHOLE);
    clearTimeout(this.checkTimer);
    this.checkTimer = setTimeout(() => void this.runCheck(), CHECK_AFTER_ms);
    this.saveSoon();
  }

  private saveSoon(): void {
    if (!this.own) return;
    clearTimeout(this.saveTimer);
    if (this.saved.peek().kind !== "saving") this.saved.set({ kind: "waiting", line: "" });
    this.saveTimer = setTimeout(() => void this.save(), SAVE_AFTER_ms);
  }

  private async runCheck(): Promise<void> {
    const turn = ++this.turn;
    this.checking.set(true);
    try {
      const found = await this.server.check(this.text);
      if (turn === this.turn) this.check.set(found);
    } catch (error) {
      if (turn === this.turn) this.check.set(unchecked(lineOf(error)));
    }
    if (turn === this.turn) this.checking.set(false);
  }
}

function now_s(): number {
  return Date.now() / 1000;
}

function localFindings(document: ProgramDocument): readonly ProgramFinding[] | null {
  const found = problemsOf(document).map(({ path, reason, remedy }) =>
    refusal({ path, place: path || "program", reason, remedy }),
  );
  return found.length ? found : null;
}

type Refusal = Pick<ProgramFinding, "path" | "place" | "reason" | "remedy">;
const refusal = (of: Refusal): ProgramFinding => ({ severity: "refused", state: "", at_mm: null, ...of });

function unchecked(reason: string): ProgramCheck {
  const remedy = "it is checked again after the next edit";
  return {
    accepted: false,
    findings: [refusal({ path: "", place: "check", reason, remedy })],
    sizes: [],
    surfaces: [],
    return_s: null,
    stiffness_cN_mm: null,
    rise_K: null,
  };
}
