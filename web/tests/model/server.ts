/** A server of one document, for stores: it keeps histories as the real one does, and can be out of reach. */

import {
  type Answer,
  applyPatch,
  type Change,
  type DocumentServer,
  type FDVVModel,
  History,
  type OpenedDocument,
  same,
} from "../../src/model";

export class Unreachable extends Error {}

export const BUTTON = "own:a";

/** What may go wrong with one question. */
export type Trouble = "out of reach" | "answer lost" | "refused";

export class ScriptedServer implements DocumentServer {
  history: History;
  revision = 0;
  /** Taken from the front, one for each change; undefined is no trouble. */
  troubles: (Trouble | undefined)[] = [];
  readonly copies: [string, FDVVModel][] = [];
  readonly changes: Change[] = [];
  /** Receives each new revision, as another tab would be. */
  readonly tabs = new Set<(revision: number) => void>();
  #known = new Map<string, number>();
  #pins: { label: string; model: FDVVModel }[] = [];

  constructor(model: FDVVModel) {
    this.history = new History(model);
  }

  /** The kinds of changes that were made, in order. */
  get seen(): string[] {
    return this.changes.map((change) => change.type);
  }

  async open(): Promise<OpenedDocument> {
    const record = { ...this.history.toJSON(), pins: this.#pins };
    return JSON.parse(JSON.stringify({ button: BUTTON, revision: this.revision, ...record }));
  }

  async send(_button: string, revision: number, sent: Change): Promise<Answer> {
    const change = JSON.parse(JSON.stringify(sent)) as Change;
    const trouble = this.troubles.shift();
    if (trouble === "out of reach") throw new Unreachable("the studio does not answer");
    if (trouble === "refused") throw new Error("the model would break");
    const known = this.#known.get(change.change_id);
    if (known === undefined && revision !== this.revision) return { conflict: await this.open() };
    if (known === undefined) this.make(change);
    if (trouble === "answer lost") throw new Unreachable("the studio does not answer");
    return { revision: this.#known.get(change.change_id)! };
  }

  /** Make a change, as if a tab had sent it. */
  make(change: Change): void {
    this.changes.push(change);
    const { opening, steps, done } = this.history.toJSON();
    if (change.type === "edit") {
      applyPatch(this.history.model, change.patch);
      const joins = change.joins && done === steps.length;
      const before = joins ? steps[done - 1]!.patches : [];
      const step = { label: change.label, patches: [...before, change.patch], time_s: change.time_s };
      const kept = [...steps.slice(0, done - Number(joins)), step];
      this.history = new History(opening, { steps: kept, done: kept.length, pins: [] });
    } else if (change.type === "undo") this.history.undo(change.count);
    else if (change.type === "redo") this.history.redo(change.count);
    else if (change.type === "pin") this.#pins.push({ label: change.label, model: this.history.model });
    else this.#pins.splice(change.index, 1);
    this.#known.set(change.change_id, ++this.revision);
    for (const tell of this.tabs) tell(this.revision);
  }

  async copy(name: string, model: FDVVModel): Promise<string> {
    this.copies.push([name, model]);
    return `own:${name}`;
  }

  unreachable(error: unknown): boolean {
    return error instanceof Unreachable;
  }

  /** Whether the server has the model that a page shows. */
  has(model: FDVVModel): boolean {
    return same(this.history.model, model);
  }
}

/** A clock that only moves when asked, ids that count, and waits that are written down. */
export function stillSurroundings(name: string) {
  let id = 0;
  const around = {
    time_s: 0,
    waits: [] as number[],
    now_s: () => around.time_s,
    newId: () => `${name}-${id++}`,
    wait: async (ms: number) => {
      around.waits.push(ms);
    },
  };
  return around;
}
