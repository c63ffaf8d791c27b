/** What is saved, and what a person decides where saving came to a stop. */

import { go } from "../../app/route";
import type { SaveState } from "../../model";
import { button, h, tell } from "../../ui";
import type { EditorController } from "./editor_controller";

const SAID: Readonly<Record<SaveState, string>> = {
  saved: "saved",
  saving: "saving…",
  lost: "not saved yet, retrying",
  conflict: "not saved",
  refused: "not saved",
  gone: "not saved",
};

/** The state in a word. */
export function savedWord(editor: EditorController): HTMLElement {
  return h(
    "span",
    { class: () => `edit-saved ${editor.saved()}`, role: "status" },
    () => SAID[editor.saved()],
  );
}

/** The strip that asks the person; empty while there is nothing to decide. */
export function savingStrip(editor: EditorController): HTMLElement {
  const content = () => {
    editor.turns();
    const state = editor.saved();
    if (state !== "conflict" && state !== "refused" && state !== "gone") return null;
    return h(
      "div",
      { class: "edit-conflict", role: "alert" },
      h("span", {}, editor.store.line ?? ""),
      state !== "gone"
        ? button({
            label: state === "conflict" ? "Use their version" : "Use the saved version",
            act: () => editor.takeTheirs(),
          })
        : null,
      button({ label: "Keep mine as a copy", kind: "main", act: () => keepMine(editor) }),
    );
  };
  return h("div", { class: "edit-saving" }, content);
}

/** Keep what is seen under another name, and go on there. */
export function keepMine(editor: EditorController): void {
  const name = `${editor.settled.peek().name} mine`;
  editor.store.keepMine(name).then((made) => go("edit", made), tell);
}
