/** Find another button by its name, in place: a field and a list, nothing that covers the page. */

import { canonical, type FDVVModel } from "../../model";
import { call } from "../../net";
import type { LibraryRow } from "../../net/messages";
import { freshId, h, onCleanup, signal, tell } from "../../ui";
import { Latest } from "./latest";
import { filled } from "./rows";

const MANY = 8;

/** A field that searches as it is typed into; `chosen` gets the model of what is taken. */
export function pickButton(label: string, chosen: (model: FDVVModel) => void): HTMLElement {
  const rows = signal<readonly LibraryRow[]>([]);
  const searching = new Latest(
    (text: string) => call("library.search", { text, limit: MANY }),
    (answer) => rows.set(answer.rows),
    tell,
  );
  onCleanup(() => searching.close());
  const take = (row: LibraryRow) => {
    call("editor.button", { button_id: row.id }).then(({ model }) => {
      rows.set([]);
      input.value = row.name;
      chosen(canonical(model as FDVVModel));
    }, tell);
  };
  const id = freshId("pick");
  const input = h("input", {
    id,
    type: "search",
    autocomplete: "off",
    placeholder: "button name",
    on: { input: () => searching.ask(input.value), focus: () => searching.ask(input.value) },
  });
  const entry = (row: LibraryRow) =>
    h(
      "li",
      {},
      h(
        "button",
        { type: "button", class: "button quiet", on: { click: () => take(row) } },
        row.name,
        h("span", { class: "muted" }, ` ${row.collection || row.origin}`),
      ),
    );
  const element = h(
    "div",
    { class: "edit-pick" },
    h("label", { for: id, class: "muted" }, label),
    input,
    filled(h("ul", { "aria-label": "Matching buttons" }), () => rows().map(entry)),
  );
  element.addEventListener("keydown", (event) => {
    if (event.key === "Escape") rows.set([]);
  });
  return element;
}
