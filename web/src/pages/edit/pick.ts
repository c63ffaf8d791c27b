/** Find another button by its name, in place: a field and a list, nothing that covers the page. */

import { call } from "../../net";
import { canonical, type FDVVModel } from "../../model";
import { freshId, h, signal, tell } from "../../ui";

const BUILT_IN = ["mx-black", "mx-blue", "mx-brown", "mx-clear", "mx-red", "rubber-dome"] as const;
const MANY = 8;

interface Row {
  readonly id: string;
  readonly name: string;
  readonly from: string;
}

/** A field that searches as it is typed into; `chosen` gets the model of what is taken. */
export function pickButton(label: string, chosen: (model: FDVVModel) => void): HTMLElement {
  const all = signal<readonly Row[]>(BUILT_IN.map((name) => ({ id: `builtin:${name}`, name, from: "built in" })));
  const text = signal<string | null>(null);
  call("document.list", {}).then(
    ({ rows }) => all.update((now) => [...rows.map(({ button, name }) => ({ id: button, name, from: "own" })), ...now]),
    tell,
  );
  const take = (row: Row) => {
    call("editor.button", { button_id: row.id }).then(({ model }) => {
      text.set(null);
      input.value = row.name;
      chosen(canonical(model as FDVVModel));
    }, tell);
  };
  const id = freshId("pick");
  const search = () => text.set(input.value.trim().toLowerCase());
  const input = h("input", {
    id,
    type: "search",
    autocomplete: "off",
    placeholder: "name of a button",
    on: { input: search, focus: search },
  });
  const found = () => {
    const sought = text();
    return sought === null ? [] : all().filter(({ name }) => name.toLowerCase().includes(sought)).slice(0, MANY);
  };
  const entry = (row: Row) =>
    h(
      "li",
      {},
      h(
        "button",
        { type: "button", class: "button quiet", on: { click: () => take(row) } },
        row.name,
        h("span", { class: "muted" }, ` ${row.from}`),
      ),
    );
  const list = h("ul", { "aria-label": "Buttons found" }, () => found().map(entry));
  const element = h("div", { class: "edit-pick" }, h("label", { for: id, class: "muted" }, label), input, list);
  element.addEventListener("keydown", (event) => {
    if (event.key === "Escape") text.set(null);
  });
  return element;
}
