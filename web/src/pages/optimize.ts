/** Optimise: play a task with one design after the other, and find the button that one plays best with. */

import { mount, unmount } from "svelte";
import type { Page } from "../app/types";
import { onCleanup } from "../ui";
import RunList from "./optimize/RunList.svelte";
import RunPage from "./optimize/RunPage.svelte";

export const page: Page = {
  title: "Optimise",
  mount(target, { id }) {
    const run = Number(id);
    const made =
      id && Number.isInteger(run) ? mount(RunPage, { target, props: { run } }) : mount(RunList, { target });
    onCleanup(() => void unmount(made));
  },
};
