/** What can be done with a button: edit it or a copy, press it, find those like it. */

import { go } from "../../app/route";
import { call } from "../../net";
import { button, type Child, tell } from "../../ui";
import type { LibraryStore } from "./store";

/** Return the buttons of the actions on one button of the library. */
export function actions(store: LibraryStore, id: string): Child[] {
  const own = id.startsWith("own:");
  return [
    own
      ? button({ label: "Edit", kind: "main", act: () => go("edit", id) })
      : button({ label: "Edit a copy", kind: "main", act: () => editCopy(id) }),
    button({ label: "Press it", act: () => go("press", id) }),
    button({
      label: "Find similar",
      act: () => store.ask({ like: id, text: "", sort: "match", descending: false }),
    }),
  ];
}

/** Make a button of one's own from another, and go and edit it. */
function editCopy(id: string): void {
  call("document.copy", { button: id, name: null }).then((made) => go("edit", made.button), tell);
}
