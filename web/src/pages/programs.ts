/** Programs: a gallery of buttons with several states, and the builder of one. */

import { mount, unmount } from "svelte";
import type { Page } from "../app/types";
import { onCleanup } from "../ui";
import ProgramsPage from "./programs/ProgramsPage.svelte";

export const page: Page = {
  title: "Programs",
  mount(target, { id, query }) {
    const made = mount(ProgramsPage, { target, props: { id, at: query.get("at") ?? "" } });
    onCleanup(() => void unmount(made));
  },
};
