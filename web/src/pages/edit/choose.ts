/** What the page shows while no button is chosen: go on with one, begin a new one, or find one. */

import { address, go } from "../../app/route";
import { call } from "../../net";
import type { DocumentRow } from "../../net/messages";
import { button, empty, h, panel, signal, tell } from "../../ui";

const MANY = 12;

/** Where to begin. */
export function chooseButton(): HTMLElement {
  const own = signal<readonly DocumentRow[]>([]);
  call("document.list", {}).then(({ rows }) => own.set(rows.slice(0, MANY)), tell);
  return h(
    "div",
    { class: "stack" },
    h("h1", {}, "Edit"),
    empty(
      "No button chosen",
      "Start a new one, or find one in the library and choose Edit there.",
      button({ label: "New tactile", kind: "main", act: () => begin("tactile") }),
      button({ label: "New linear", act: () => begin("linear") }),
      h("a", { class: "button", href: address("library") }, "Library"),
      h("a", { class: "button", href: address("edit", "builtin:mx-clear") }, "MX Clear, as an example"),
    ),
    () =>
      own().length ? panel("Your buttons, newest first", h("div", { class: "row" }, own().map(link))) : null,
  );
}

function link({ button: id, name }: DocumentRow): HTMLElement {
  return h("a", { class: "button", href: address("edit", id) }, name);
}

function begin(template: "tactile" | "linear"): void {
  call("document.create", { name: null, template, model: null }).then(
    (made) => go("edit", made.button),
    tell,
  );
}
