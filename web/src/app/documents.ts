/** Documents of the studio: what a store needs of the server, and news of other tabs. */

import type { Answer, Change, DocumentServer, DocumentStore, FDVVModel, OpenedDocument } from "../model";
import { call, type Document, live, StudioError } from "../net";
import type { Cleanup } from "../ui";
import { nameOf } from "./names";

/** What the server refuses for good; anything else may be well the next time. */
const REFUSED: ReadonlySet<number> = new Set([400, 413, 415, 422]);

function opened(found: Document): OpenedDocument {
  // the server has read the model, and wrote it as a model file would hold it
  return found as unknown as OpenedDocument;
}

/** The studio's server, as a store needs it. */
export const documents: DocumentServer = {
  open: async (button) => opened(await call("document.open", { button })),
  send: async (button, revision, change: Change): Promise<Answer> => {
    type Ask = Parameters<typeof call<"document.change">>[1];
    const found = await call("document.change", { button, revision, change } as unknown as Ask);
    return found.conflict ? { conflict: opened(found.conflict) } : { revision: found.revision };
  },
  copy: async (name, model) =>
    (await call("document.create", { name, template: null, model: plain(model) })).button,
  unreachable: (error) => !(error instanceof StudioError && REFUSED.has(error.status)),
};

function plain(model: FDVVModel): Record<string, unknown> {
  return { ...model };
}

/**
 * Keep a store up to date: other tabs are followed, and a page that is left with something unsaved asks first.
 * The function given back ends it, and the store. button : the id that it has by now.
 */
export function follow(store: DocumentStore, button: () => string = () => store.button): Cleanup {
  const channel = live().channel("documents", {
    opened: (channel) => void channel.send({ type: "watch" }),
    onMessage: (news) => {
      // before the watch was in force others may have been at work
      if (news.type === "watching") return void store.refresh();
      if (news.button !== button()) return;
      if (news.type === "changed") void store.onRevision(news.revision);
      else store.gone(goneLine(news.renamed_to));
    },
  });
  const leaving = (event: BeforeUnloadEvent) => {
    if (store.unsaved) event.preventDefault();
  };
  addEventListener("beforeunload", leaving);
  return () => {
    removeEventListener("beforeunload", leaving);
    channel.close();
    store.close();
  };
}

function goneLine(renamedTo: string | null): string {
  return renamedTo ? `this button is now called ${nameOf(renamedTo)}` : "this button was deleted";
}
