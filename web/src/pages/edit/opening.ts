/** Open a button to edit it; one that is not the person's own is copied when it is first changed. */

import { documents, follow } from "../../app/documents";
import { address } from "../../app/route";
import { type DocumentServer, DocumentStore } from "../../model";
import { call } from "../../net";
import { onCleanup, type Signal, signal } from "../../ui";

const OWN = "own:";

/** An open button and the id that it has by now. */
export interface Opened {
  readonly store: DocumentStore;
  readonly button: Signal<string>;
}

/** Open a button by its id. Rejects with one line for the person. */
export async function openButton(id: string): Promise<Opened> {
  const button = signal(id);
  const store = await DocumentStore.open(id.startsWith(OWN) ? documents : copiedOnChange(button), id);
  return { store, button };
}

/** Keep an open button up to date for as long as the scope lasts. */
export function followButton({ store, button }: Opened): void {
  onCleanup(follow(store, () => button.peek()));
}

/** A server that copies the button before its first change, and from then on means the copy. */
function copiedOnChange(button: Signal<string>): DocumentServer {
  let copying: Promise<string> | null = null;
  const own = async () => {
    copying ??= call("document.copy", { button: button.peek(), name: null }).then((made) => made.button);
    try {
      return await copying;
    } catch (error) {
      copying = null;
      throw error;
    }
  };
  return {
    ...documents,
    open: () => documents.open(button.peek()),
    send: async (_button, revision, change) => {
      const copy = await own();
      const answer = await documents.send(copy, revision, change);
      if (button.peek() !== copy) {
        button.set(copy);
        history.replaceState(null, "", address("edit", copy));
      }
      return answer;
    },
  };
}
