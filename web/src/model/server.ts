/** What a document needs of a server, and what may come of it. */

import type { HistoryRecord } from "./history";
import type { Patch } from "./patch";
import type { FDVVModel } from "./types";

/** A document as the server gives it. */
export interface OpenedDocument extends HistoryRecord {
  /** Such as `own:my-button`. */
  readonly button: string;
  /** Counts every change of it. */
  readonly revision: number;
}

interface EditChange {
  readonly type: "edit";
  readonly label: string;
  readonly patch: Patch;
  readonly joins: boolean;
  readonly time_s: number;
}

/** What is done to a document, before it has an id. */
export type Doing =
  | EditChange
  | { readonly type: "undo"; readonly count: number }
  | { readonly type: "redo"; readonly count: number }
  | { readonly type: "pin"; readonly label: string }
  | { readonly type: "unpin"; readonly index: number };

/** One thing to tell the server, in the order it was done; by its id it is not made twice. */
export type Change = Doing & { readonly change_id: string };

/** What became of a change: the revision it made, or the document as others left it. */
export type Answer = { readonly revision: number } | { readonly conflict: OpenedDocument };

/** The server; `open` and `send` reject where it is out of reach or refuses. */
export interface DocumentServer {
  open(button: string): Promise<OpenedDocument>;
  send(button: string, revision: number, change: Change): Promise<Answer>;
  /** Keep a model under another name; gives its id. */
  copy(name: string, model: FDVVModel): Promise<string>;
  /** Whether an error means that the server was out of reach, so that it is worth trying again. */
  unreachable(error: unknown): boolean;
}

/** Time, chance and patience, passed in so that tests hold them. */
export interface Surroundings {
  readonly now_s: () => number;
  readonly newId: () => string;
  readonly wait: (ms: number) => Promise<void>;
}

/** Those of a browser. */
export const BROWSER: Surroundings = {
  now_s: () => Date.now() / 1000,
  newId: () => crypto.randomUUID(),
  wait: (ms) => new Promise((resolve) => setTimeout(resolve, ms)),
};
