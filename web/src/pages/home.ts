/** The first page: what to begin with, and what was worked on. */

import { mount, unmount } from "svelte";
import type { Page } from "../app/types";
import { onCleanup } from "../ui";
import HomePage from "./home/HomePage.svelte";

export const page: Page = {
  title: "Home",
  mount(target) {
    const made = mount(HomePage, { target });
    onCleanup(() => void unmount(made));
  },
};
