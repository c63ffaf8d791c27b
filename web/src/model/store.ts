/**
 * A document on the page and its twin on the server.
 *
 * What a designer does is seen at once and sent in order. A lost connection only delays it: what is unsaved is
 * kept, said to be unsaved, and sent until it is answered; every change bears an id, so that one that was
 * answered into the void is not made twice. Other tabs are followed while nothing is unsaved; where two have
 * edited the same state, the person chooses.
 */

import type { Edit } from "./edit";
import { History, type HistoryRecord, type Made, type Pin, type Step } from "./history";
import type { Patch } from "./patch";
import type { FDVVModel } from "./types";

/** A document as the server gives it. */
export interface OpenedDocument extends HistoryRecord {
  /** Such as `own:my-button`. */
  readonly button: string;
  /** Counts every change of it. */
  readonly revision: number;
}

/** One thing to tell the server, in the order it was done. */
export type Change = { readonly change_id: string } & (
  | { readonly type: "edit"; readonly label: string; readonly patch: Patch; readonly joins: boolean; readonly time_s: number }
  | { readonly type: "undo"; readonly count: number }
  | { readonly type: "redo"; readonly count: number }
  | { readonly type: "pin"; readonly label: string }
  | { readonly type: "unpin"; readonly index: number }
);

type Told = Change extends infer C ? (C extends Change ? Omit<C, "change_id"> : never) : never;

/** What became of a change: the revision it made, or the document as others left it. */
export type Answer = { readonly revision: number } | { readonly conflict: OpenedDocument };

/** What the store needs of a server; `open` and `send` reject where it is out of reach or refuses. */
export interface DocumentServer {
  open(button: string): Promise<OpenedDocument>;
  send(button: string, revision: number, change: Change): Promise<Answer>;
  /** Keep a model under another name; gives its id. */
  copy(name: string, model: FDVVModel): Promise<string>;
  /** Whether an error means that the server was out of reach, so that it is worth trying again. */
  unreachable(error: unknown): boolean;
}

/**
 * saved: the server has everything. saving: it is being sent. lost: it will be, once the server answers.
 * conflict: another tab edited the same state. refused: the server does not take it. gone: it was deleted or renamed.
 */
export type SaveState = "saved" | "saving" | "lost" | "conflict" | "refused" | "gone";

/** Time, chance and patience, passed in so that tests hold them. */
export interface Surroundings {
  readonly now_s: () => number;
  readonly newId: () => string;
  readonly wait: (ms: number) => Promise<void>;
}

const AGAIN_ms = [300, 1000, 2000, 5000] as const;

const REAL: Surroundings = {
  now_s: () => Date.now() / 1000,
  newId: () => crypto.randomUUID(),
  wait: (ms) => new Promise((resolve) => setTimeout(resolve, ms)),
};

/** An open document: its history, and its way to the server. */
export class DocumentStore {
  #history: History;
  #revision: number;
  #queue: Change[] = [];
  #state: SaveState = "saved";
  #line: string | null = null;
  #theirs: OpenedDocument | null = null;
  #newest: number;
  #sending: Promise<void> | null = null;
  #closed = false;
  readonly #listeners = new Set<() => void>();
  /** The id it was opened by. */
  readonly button: string;
  /** The model when it was opened here, to compare with. */
  readonly before: FDVVModel;
  readonly #server: DocumentServer;
  readonly #around: Surroundings;

  constructor(server: DocumentServer, opened: OpenedDocument, around: Surroundings = REAL) {
    this.#server = server;
    this.#around = around;
    this.button = opened.button;
    this.#history = History.fromJSON(opened);
    this.#revision = this.#newest = opened.revision;
    this.before = this.#history.model;
  }

  /** Open a document. Rejects as the server does. */
  static async open(server: DocumentServer, button: string, around: Surroundings = REAL): Promise<DocumentStore> {
    return new DocumentStore(server, await server.open(button), around);
  }

  /** The model as it is shown, a drag under way included. */
  get model(): FDVVModel {
    return this.#history.model;
  }

  /** The history, to read; it is changed through the store. */
  get history(): Pick<History, "opening" | "steps" | "done" | "canUndo" | "canRedo" | "undoLabel" | "redoLabel" | "dragging" | "at" | "changed"> {
    return this.#history;
  }

  get pins(): readonly Pin[] {
    return this.#history.pins;
  }

  get steps(): readonly Step[] {
    return this.#history.steps;
  }

  get state(): SaveState {
    return this.#state;
  }

  /** One line for the person where something is wrong; else null. */
  get line(): string | null {
    return this.#line;
  }

  /** How many changes the server does not have yet. */
  get unsaved(): number {
    return this.#queue.length;
  }

  /** Run a listener after every change of model, history or state; the function given back ends it. */
  onChange(listener: () => void): () => void {
    this.#listeners.add(listener);
    return () => this.#listeners.delete(listener);
  }

  /** Do an edit. Throws ModelError, and then nothing has changed. nudge : edits of one kind become one step. */
  apply(edit: Edit, nudge?: string): boolean {
    const when = { time_s: this.#around.now_s(), ...(nudge === undefined ? {} : { nudge }) };
    return this.#made(this.#history.apply(edit, when), when.time_s);
  }

  /** Begin a drag. */
  mark(label: string): void {
    this.#history.mark(label);
  }

  /** Show what an edit of the marked state gives. Throws ModelError, and then what was shown stays. */
  drag(edit: Edit): FDVVModel {
    const model = this.#history.drag(edit);
    this.#tell();
    return model;
  }

  /** End a drag as one step; false if it changed nothing. */
  release(): boolean {
    const time_s = this.#around.now_s();
    const made = this.#made(this.#history.release(time_s), time_s);
    if (!made) this.#settled();
    return made;
  }

  /** End a drag as if it had not been. */
  cancel(): void {
    this.#history.cancel();
    this.#settled();
  }

  undo(count = 1): number {
    const done = this.#history.undo(count);
    if (done) this.#send({ type: "undo", count: done });
    return done;
  }

  redo(count = 1): number {
    const done = this.#history.redo(count);
    if (done) this.#send({ type: "redo", count: done });
    return done;
  }

  /** Keep the present state to compare with. */
  pin(label: string): void {
    this.#history.pin(label);
    this.#send({ type: "pin", label });
  }

  unpin(index: number): void {
    this.#history.unpin(index);
    this.#send({ type: "unpin", index });
  }

  /** Take the news of another tab: the document has this revision. */
  async told(revision: number): Promise<void> {
    this.#newest = Math.max(this.#newest, revision);
    await this.#follow();
  }

  /** Take the news that the document was deleted or renamed. */
  gone(line: string): void {
    this.#set("gone", line);
  }

  /**
   * After a conflict or a refusal: take what the server has; what is unsaved here is dropped. Rejects, and keeps
   * everything, where the server is out of reach.
   */
  async takeTheirs(): Promise<void> {
    const theirs = this.#theirs ?? (await this.#server.open(this.button));
    this.#queue = [];
    this.#become(theirs);
    this.#set("saved", null);
    await this.#follow();
  }

  /** Keep the model as it is here under another name, and take theirs here. Gives the id of the copy. */
  async keepMine(name: string): Promise<string> {
    const button = await this.#server.copy(name, this.#history.model);
    await this.takeTheirs();
    return button;
  }

  /** Look whether others changed the document while nobody told of it. */
  async refresh(): Promise<void> {
    await this.#follow(true);
  }

  /** Wait until nothing is on its way: everything is saved, or a person must decide. */
  async settled(): Promise<void> {
    while (this.#sending) await this.#sending;
  }

  /** Stop trying to reach the server. */
  close(): void {
    this.#closed = true;
    this.#listeners.clear();
  }

  #made(made: Made | null, time_s: number): boolean {
    if (!made) return false;
    this.#send({ type: "edit", ...made, time_s });
    return true;
  }

  #send(change: Told): void {
    this.#queue.push({ ...change, change_id: this.#around.newId() });
    if (this.#state === "saved") this.#state = "saving";
    this.#tell();
    this.#sending ??= this.#drain();
  }

  /** Send what is unsaved, one after the other, then look at what others did meanwhile. */
  async #drain(): Promise<void> {
    do {
      for (let tries = 0; this.#queue.length && !this.#stuck(); ) {
        tries = (await this.#sendFirst()) ? 0 : tries + 1;
        if (tries) await this.#around.wait(AGAIN_ms[Math.min(tries, AGAIN_ms.length) - 1]!);
      }
      await this.#follow();
      // an edit made during the last look has to be sent as well
    } while (this.#queue.length && !this.#stuck());
    this.#sending = null;
  }

  /** Send one change; false if the server was out of reach. */
  async #sendFirst(): Promise<boolean> {
    try {
      const answer = await this.#server.send(this.button, this.#revision, this.#queue[0]!);
      if ("conflict" in answer) this.#inConflict(answer.conflict);
      else this.#taken(answer.revision);
      return true;
    } catch (error) {
      const lost = this.#server.unreachable(error);
      if (!this.#stuck()) this.#set(lost ? "lost" : "refused", lineOf(error));
      return !lost;
    }
  }

  #stuck(): boolean {
    return this.#closed || this.#state === "conflict" || this.#state === "refused" || this.#state === "gone";
  }

  #taken(revision: number): void {
    this.#queue.shift();
    this.#revision = revision;
    this.#newest = Math.max(this.#newest, revision);
    if (!this.#stuck()) this.#set(this.#queue.length ? "saving" : "saved", null);
  }

  #inConflict(theirs: OpenedDocument): void {
    this.#theirs = theirs;
    this.#set("conflict", "another tab edited this button; take theirs, or keep yours as a copy");
  }

  #settled(): void {
    this.#tell();
    void this.#follow();
  }

  /** Take over what another tab made, while nothing here is unsaved or being dragged. */
  async #follow(anyway = false): Promise<void> {
    if (!this.#idle() || !(anyway || this.#newest > this.#revision)) return;
    try {
      const opened = await this.#server.open(this.button);
      if (!this.#idle() || opened.revision <= this.#revision) return;
      this.#become(opened);
      this.#tell();
    } catch (error) {
      // out of reach is no news: what is shown is what is saved
      if (!this.#server.unreachable(error)) this.#set("gone", lineOf(error));
    }
  }

  #idle(): boolean {
    return !this.#queue.length && !this.#history.dragging && !this.#stuck();
  }

  #become(opened: OpenedDocument): void {
    this.#history = History.fromJSON(opened);
    this.#revision = opened.revision;
    this.#newest = Math.max(this.#newest, opened.revision);
    this.#theirs = null;
  }

  #set(state: SaveState, line: string | null): void {
    this.#state = state;
    this.#line = line;
    this.#tell();
  }

  #tell(): void {
    for (const listener of [...this.#listeners]) listener();
  }
}

function lineOf(error: unknown): string {
  return error instanceof Error ? error.message : String(error);
}
