/** Studies: declare, freeze, have people sit down, see how far they are, unseal. Never what a label hides. */

import { mount, unmount } from "svelte";
import type { Page } from "../app/types";
import { onCleanup } from "../ui";
import StudyList from "./studies/StudyList.svelte";
import StudyPage from "./studies/StudyPage.svelte";

export const page: Page = {
  title: "Studies",
  mount(target, { id }) {
    const made = id ? mount(StudyPage, { target, props: { study: id } }) : mount(StudyList, { target });
    onCleanup(() => void unmount(made));
  },
};
