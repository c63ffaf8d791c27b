/**
 * A document on the page and its twin on the server.
 *
 * What a designer does is seen at once and sent in order. A lost connection only delays it: what is unsaved is
 * kept, said to be unsaved, and sent until it is answered; every change bears an id, so that one that was
 * answered into the void is not made twice. Other tabs are followed while nothing is unsaved; where two have
 * edited the same state, the person chooses.
 */

import { lineOf } from "../math/words";
import type { Edit } from "./edit";
import { History, type Made, type Pin, type Step } from "./history";
import { Outbox, type Sent } from "./outbox";
import {
  BROWSER,
  type Change,
  type DocumentServer,
  type Doing,
  type OpenedDocument,
  type Surroundings,
} from "./server";
import type { FDVVModel } from "./types";

/**
 * saved: the server has everything. saving: it is being sent. lost: it will be, once the server answers.
 * conflict: another tab edited the same state. refused: the server does not take it. gone: it was deleted or renamed.
 */
export type SaveState = "saved" | "saving" | "lost" | "conflict" | "refused" | "gone";

/** The history as a page reads it. */
export type HistoryView = Pick<
  History,
  | "opening"
  | "steps"
  | "done"
  | "canUndo"
  | "canRedo"
  | "undoLabel"
  | "redoLabel"
  | "dragging"
  | "at"
  | "changed"
>;

const IN_CONFLICT = "another tab edited this button; use its version, or keep yours as a copy";

/** An open document: its history, and its way to the server. */
export class DocumentStore {
  #history: History;
  #revision: number;
  #newest: number;
  #state: SaveState = "saved";
  #line: string | null = null;
  #theirs: OpenedDocument | null = null;
  #closed = false;
  readonly #outbox: Outbox;
  readonly #listeners = new Set<() => void>();
  readonly #server: DocumentServer;
  readonly #around: Surroundings;
  /** The id it was opened by. */
  readonly button: string;
  /** The model when it was opened here, to compare with. */
  readonly before: FDVVModel;

  constructor(server: DocumentServer, opened: OpenedDocument, around: Surroundings = BROWSER) {
    this.#server = server;
    this.#around = around;
    this.button = opened.button;
    this.#history = History.fromJSON(opened);
    this.#revision = this.#newest = opened.revision;
    this.before = this.#history.model;
    this.#outbox = new Outbox(
      around,
      (change) => this.#post(change),
      () => this.#stuck(),
      () => this.#follow(),
    );
  }

  /** Open a document. Rejects as the server does. */
  static async open(
    server: DocumentServer,
    button: string,
    around: Surroundings = BROWSER,
  ): Promise<DocumentStore> {
    return new DocumentStore(server, await server.open(button), around);
  }

  /** The model as it is shown, a drag under way included. */
  get model(): FDVVModel {
    return this.#history.model;
  }

  /** The history, to read; it is changed through the store. */
  get history(): HistoryView {
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
    return this.#outbox.size;
  }

  /** Run a listener after every change of model, history or state; the function given back ends it. */
  onChange(listener: () => void): () => void {
    this.#listeners.add(listener);
    return () => this.#listeners.delete(listener);
  }

  /** Do an edit. Throws ModelError, and then nothing has changed. nudge : edits of one kind become one step. */
  apply(edit: Edit, nudge?: string): boolean {
    const time_s = this.#around.now_s();
    return this.#made(this.#history.apply(edit, { time_s, nudge }), time_s);
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
    if (!made) this.#rested();
    return made;
  }

  /** End a drag as if it had not been. */
  cancel(): void {
    this.#history.cancel();
    this.#rested();
  }

  undo(count = 1): number {
    const done = this.#history.undo(count);
    if (done) this.#do({ type: "undo", count: done });
    return done;
  }

  redo(count = 1): number {
    const done = this.#history.redo(count);
    if (done) this.#do({ type: "redo", count: done });
    return done;
  }

  /** Keep the present state to compare with. */
  pin(label: string): void {
    this.#history.pin(label);
    this.#do({ type: "pin", label });
  }

  unpin(index: number): void {
    this.#history.unpin(index);
    this.#do({ type: "unpin", index });
  }

  /** Take the news of another tab: the document has this revision. */
  async onRevision(revision: number): Promise<void> {
    this.#newest = Math.max(this.#newest, revision);
    await this.#follow();
  }

  /** The server is there again: send what waits, and look whether others changed the document meanwhile. */
  async refresh(): Promise<void> {
    this.#outbox.hurry();
    await this.#follow(true);
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
    this.#outbox.clear();
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

  /** Wait until nothing is on its way: everything is saved, or a person must decide. */
  settled(): Promise<void> {
    return this.#outbox.settled();
  }

  /** Stop trying to reach the server. */
  close(): void {
    this.#closed = true;
    this.#outbox.hurry();
    this.#listeners.clear();
  }

  #made(made: Made | null, time_s: number): boolean {
    if (made) this.#do({ type: "edit", ...made, time_s });
    return made !== null;
  }

  #do(doing: Doing): void {
    this.#outbox.add(doing);
    if (this.#state === "saved") this.#state = "saving";
    this.#tell();
    this.#outbox.start();
  }

  async #post(change: Change): Promise<Sent> {
    try {
      const answer = await this.#server.send(this.button, this.#revision, change);
      if (!("conflict" in answer)) return this.#kept(change, answer.revision);
      this.#theirs = answer.conflict;
      this.#set("conflict", IN_CONFLICT);
      return "stopped";
    } catch (error) {
      const lost = this.#server.unreachable(error);
      if (!this.#stuck()) this.#set(lost ? "lost" : "refused", lineOf(error));
      return lost ? "lost" : "stopped";
    }
  }

  #kept(change: Change, revision: number): Sent {
    if (!this.#outbox.taken(change)) return "kept";
    this.#revision = revision;
    this.#newest = Math.max(this.#newest, revision);
    if (!this.#stuck()) this.#set(this.#outbox.size ? "saving" : "saved", null);
    return "kept";
  }

  #stuck(): boolean {
    return this.#closed || this.#state === "conflict" || this.#state === "refused" || this.#state === "gone";
  }

  #rested(): void {
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
    return !this.#outbox.size && !this.#history.dragging && !this.#stuck();
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
