/** Programs: a gallery of buttons with several states, and the builder of one. */

import { go } from "../app/route";
import type { Page } from "../app/types";
import { lineOf } from "../math/words";
import { call } from "../net";
import type { ProgramText } from "../net/messages";
import { button, type Cleanup, empty, h, onCleanup, scope } from "../ui";
import { editor } from "./programs/editor";
import { gallery } from "./programs/gallery";
import "./programs/programs.css";

export const page: Page = {
  title: "Programs",
  mount(host, { id, query }) {
    host.classList.add("programs-page");
    onCleanup(() => host.classList.remove("programs-page"));
    if (id) openProgram(host, id, query.get("at") ?? "");
    else gallery(host);
  },
};

/** Open a program in a scope of its own, for it comes when the page may be gone. */
function openProgram(host: HTMLElement, id: string, at: string): void {
  let gone = false;
  let leave: Cleanup = () => undefined;
  onCleanup(() => {
    gone = true;
    leave();
  });
  const place = h("div", { class: "stack" }, h("p", { class: "muted", role: "status" }, "Opening…"));
  host.append(place);
  const show = (opened: ProgramText): void => {
    if (gone) return;
    place.replaceChildren();
    leave = scope(() => editor(place, opened, at));
  };
  const missing = (error: unknown): void =>
    place.replaceChildren(
      empty(
        "It cannot be opened",
        lineOf(error),
        button({ label: "All programs", act: () => go("programs") }),
      ),
    );
  call("program.open", { program: id }).then(show, missing);
}
