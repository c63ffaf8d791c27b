/** The library: find buttons, compare them, begin from one. */

import { mount, unmount } from "svelte";
import type { Page } from "../app/types";
import { batch, onCleanup } from "../ui";
import LibraryPage from "./library/LibraryPage.svelte";
import "./library/library.css";

export const page: Page = {
  title: "Library",
  followsRoute: true,
  mount(target) {
    // a component may not be interrupted while it is made: what it changes is followed when it stands
    batch(() => {
      const made = mount(LibraryPage, { target });
      onCleanup(() => void unmount(made));
    });
  },
};
