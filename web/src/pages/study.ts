/** The participant's screen of a study: nothing of the studio around it, and nothing that tells what a label hides. */

import type { Page } from "../app/types";
import { seat } from "../net";
import { h } from "../ui";
import { studyScreen } from "./study/screen";
import { StudySession } from "./study/session";
import "./study/study.css";

export const page: Page = {
  title: "Study",
  mount(host, route) {
    const session = new StudySession(route.id, seat() || (route.query.get("seat") ?? ""));
    host.append(h("div", { class: "study-page", lang: session.language }, studyScreen(session)));
  },
};
