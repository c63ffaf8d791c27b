/** The participant's screen of a study: nothing of the studio around it, and nothing that tells what a label hides. */

import { mount, unmount } from "svelte";
import type { Page } from "../app/types";
import { seat } from "../net";
import { onCleanup } from "../ui";
import StudyEntry from "./study/StudyEntry.svelte";
import "./study/study.css";

export const page: Page = {
  title: "Study",
  mount(target, { id, query }) {
    const props = { study: id, seat: seat() || (query.get("seat") ?? "") };
    const made = mount(StudyEntry, { target, props });
    onCleanup(() => void unmount(made));
  },
};
