/** The library: find buttons, compare them, begin from one. */

import type { Page } from "../app/types";
import { addShortcuts, h, signal } from "../ui";
import { compare } from "./library/compare";
import { filters } from "./library/filters";
import { finder } from "./library/finder";
import { LibraryStore } from "./library/store";
import "./library/library.css";

export const page: Page = {
  title: "Library",
  followsRoute: true,
  mount(host) {
    const store = new LibraryStore();
    const filtering = signal(matchMedia("(min-width: 1180px)").matches);
    const toggle = () => filtering.update((on) => !on);
    const found = finder(store, (id) => open(store, host, id), toggle);
    host.append(
      h("h1", { class: "visually-hidden" }, "Library"),
      h(
        "div",
        { class: () => `lib${filtering() ? " filtering" : ""}` },
        h(
          "section",
          { class: "panel lib-filters", "aria-label": "Filters", hidden: () => !filtering() },
          filters(store),
        ),
        found.element,
        compare(store),
      ),
    );
    const key = (event: KeyboardEvent) => found.list.onKey(event);
    addShortcuts(
      { keys: "/", does: "Search", act: () => found.search.select() },
      { keys: "F", does: "Show or hide the filters", act: toggle },
      { keys: "ArrowDown", does: "Next button", act: key },
      { keys: "ArrowUp", does: "Previous button", act: key },
      { keys: "Space", does: "Add the button to the comparison, or remove it", act: key },
      { keys: "Enter", does: "Details of the button, and actions", act: key },
      { keys: "L", does: "Find buttons that feel like it", act: () => like(store) },
    );
  },
};

/** Show what is known of a button, with what can be done with it at hand. */
function open(store: LibraryStore, host: HTMLElement, id: string): void {
  store.show({ tab: "about" });
  const began = performance.now();
  const focus = () => {
    const action = host.querySelector<HTMLElement>(`.lib-actions[data-id="${CSS.escape(id)}"] button`);
    if (action) action.focus();
    else if (performance.now() - began < 2000) requestAnimationFrame(focus);
  };
  focus();
}

function like(store: LibraryStore): void {
  const id = store.activeId();
  if (id) store.ask({ like: id, text: "", sort: "match", descending: false });
}
