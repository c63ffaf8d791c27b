/** What can be done with a button: open it, edit a copy, press it, find those like it. */

import { go } from "../../app/route";
import { button, type Child } from "../../ui";
import type { LibraryStore } from "./store";

/** Give the buttons of the actions on one button of the library. */
export function actions(store: LibraryStore, id: string): Child[] {
  const own = id.startsWith("own:");
  return [
    button({ label: own ? "Edit" : "Edit a copy", kind: "main", act: () => go("edit", id) }),
    button({ label: "Press it", act: () => go("press", id) }),
    button({ label: "Find alike", act: () => store.ask({ like: id, text: "", sort: "match", descending: false }) }),
  ];
}
