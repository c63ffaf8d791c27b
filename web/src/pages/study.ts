/** The participant's screen of a study: nothing of the studio around it, and nothing that tells what a label hides. */

import { mount, unmount } from "svelte";
import type { Page } from "../app/types";
import { seat } from "../net";
import { onCleanup } from "../ui";
import StudyScreen from "./study/StudyScreen.svelte";
import { StudySession } from "./study/session";
import "./study/study.css";

export const page: Page = {
  title: "Study",
  mount(target, { id, query }) {
    const session = new StudySession(id, seat() || (query.get("seat") ?? ""));
    const made = mount(StudyScreen, { target, props: { session } });
    onCleanup(() => void unmount(made));
  },
};
