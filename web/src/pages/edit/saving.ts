/** What is saved, and what a person decides where saving came to a stop. */

import { go } from "../../app/route";
import type { SaveState } from "../../model";
import { button, h, tell } from "../../ui";
import type { Desk } from "./desk";

const SAID: Readonly<Record<SaveState, string>> = {
  saved: "saved",
  saving: "saving…",
  lost: "not saved yet, trying again",
  conflict: "not saved",
  refused: "not saved",
  gone: "not saved",
};

/** The state in a word. */
export function savedWord(desk: Desk): HTMLElement {
  return h("span", { class: () => `edit-saved ${desk.saved()}`, role: "status" }, () => SAID[desk.saved()]);
}

/** The strip that asks the person; empty while there is nothing to decide. */
export function savingStrip(desk: Desk): HTMLElement {
  const content = () => {
    desk.turns();
    const state = desk.saved();
    if (state !== "conflict" && state !== "refused" && state !== "gone") return null;
    return h(
      "div",
      { class: "edit-conflict", role: "alert" },
      h("span", {}, desk.store.line ?? ""),
      state !== "gone" ? button({ label: state === "conflict" ? "Take theirs" : "Take what is saved", act: () => desk.takeTheirs() }) : null,
      button({ label: "Keep mine as a copy", kind: "main", act: () => keepMine(desk) }),
    );
  };
  return h("div", { class: "edit-saving" }, content);
}

/** Keep what is seen under another name, and go on there. */
export function keepMine(desk: Desk): void {
  const name = `${desk.settled.peek().name} mine`;
  desk.store.keepMine(name).then((made) => go("edit", made), tell);
}
