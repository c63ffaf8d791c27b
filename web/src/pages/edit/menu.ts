/** Menus that open under their name and close when they are left. */

import { go } from "../../app/route";
import { call } from "../../net";
import { button, type Child, h, tell } from "../../ui";
import type { EditorController } from "./editor_controller";

/** A menu; Escape closes it and goes back to its name. */
export function dropDown(label: string, items: readonly Child[]): HTMLElement {
  const name = h("summary", { class: "button" }, label);
  const menu = h("details", { class: "edit-menu" }, name, h("div", { class: "edit-menu-items" }, items));
  menu.addEventListener("keydown", (event) => {
    if (event.key !== "Escape" || !menu.open) return;
    menu.open = false;
    name.focus();
  });
  // what was chosen is done: the menu need not stay in the way
  menu.addEventListener("click", (event) => {
    if (event.target instanceof HTMLButtonElement) menu.open = false;
  });
  menu.addEventListener("focusout", (event) => {
    if (!menu.contains(event.relatedTarget as Node | null)) menu.open = false;
  });
  return menu;
}

/** What is done with the button as a whole. */
export function buttonMenu(editor: EditorController, id: () => string): HTMLElement {
  const input = h("input", { type: "text", "aria-label": "New name", value: editor.settled.peek().name });
  const rename = () => {
    call("document.rename", { button: id(), name: input.value.trim() }).then(
      (made) => go("edit", made.button),
      tell,
    );
  };
  const duplicate = () => {
    const model = { ...editor.settled.peek() };
    call("document.create", { name: null, template: null, model }).then(
      (made) => go("edit", made.button),
      tell,
    );
  };
  input.addEventListener("keydown", (event) => {
    if (event.key === "Enter") rename();
  });
  const own = () => id().startsWith("own:");
  return dropDown("Button", [
    button({ label: "Duplicate", kind: "quiet", act: duplicate }),
    h("div", { class: "edit-rename", hidden: () => !own() }, input, button({ label: "Rename", act: rename })),
  ]);
}
