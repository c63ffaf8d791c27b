/** The left half: search line, how many were found, sorting, the list, and what to say where it is empty. */

import { button, type Child, choice, computed, effect, empty, h, progress } from "../../ui";
import { COLUMNS, columnOf } from "./columns";
import { ButtonList, listedColumns } from "./list";
import { refusedFiles } from "./refused";
import type { LibraryStore } from "./store";

export interface Finder {
  readonly element: HTMLElement;
  readonly search: HTMLInputElement;
  readonly list: ButtonList;
}

export function finder(store: LibraryStore, open: (id: string) => void, showFilters: () => void): Finder {
  const list = new ButtonList(store, open);
  const search = searchLine(store, list);
  // of its own: a letter that is typed changes nothing that is read out until its answer is there
  const like = computed(() => store.query().like);
  const element = h(
    "section",
    { class: "panel lib-finder", "aria-label": "Buttons" },
    h(
      "div",
      { class: "row" },
      search,
      button({ label: "Filters", act: showFilters, hint: "Show or hide the filters (F)" }),
    ),
    h(
      "div",
      { class: "row spread lib-status" },
      h("span", { role: "status" }, () => status(store, like())),
      sorting(store),
    ),
    () => indexing(store),
    heads(store),
    h("div", { class: "lib-list-place" }, list.element, () => nothing(store)),
    refusedFiles(store),
  );
  return { element, search, list };
}

function searchLine(store: LibraryStore, list: ButtonList): HTMLInputElement {
  const search: HTMLInputElement = h("input", {
    type: "search",
    class: "lib-search",
    placeholder: "Search names, folders, makers  ( / )",
    "aria-label": "Search buttons",
    autocomplete: "off",
    spellcheck: "false",
    maxlength: 200,
    on: { input: () => store.ask({ text: search.value }) },
  });
  effect(() => {
    const { text } = store.query();
    if (search.value !== text) search.value = text;
  });
  search.addEventListener("keydown", (event) => {
    if (event.key === "ArrowDown" || event.key === "Enter") {
      event.preventDefault();
      list.element.focus();
    } else if (event.key === "Escape" && search.value) {
      event.preventDefault();
      store.ask({ text: "" });
    }
  });
  return search;
}

function status(store: LibraryStore, like: string | null): Child {
  store.grown();
  const { positions, mended } = store.found();
  const of =
    positions.length === store.rows.length
      ? `${positions.length} buttons`
      : `${positions.length} of ${store.rows.length} buttons`;
  const typo = mended.length ? `; no match for “${mended.join("”, “")}”: one letter changed` : "";
  const near = like === null ? "" : `, nearest first to ${store.rows.names[store.rows.at(like)] ?? like}`;
  return [
    `${of}${near}${typo}`,
    like === null
      ? null
      : button({
          label: "Stop sorting by similarity",
          glyph: "×",
          kind: "quiet",
          act: () => store.ask({ like: null }),
        }),
  ];
}

function sorting(store: LibraryStore): HTMLElement {
  const options = [
    ["match", "best match"],
    ["name", "name"],
    ["kind", "type"],
    ["origin", "origin"],
    ["date", "date"],
    ...COLUMNS.map((one) => [one.name, one.short.toLowerCase()]),
  ] as [string, string][];
  return h(
    "span",
    { class: "row lib-sort" },
    choice({
      label: "Sort by",
      options,
      value: () => store.query().sort,
      set: (sort) => store.ask({ sort, descending: false }),
    }),
    button({
      label: "Reverse the order",
      glyph: "⇅",
      kind: "quiet",
      pressed: () => store.query().descending,
      act: () => store.ask({ descending: !store.query.peek().descending }),
    }),
  );
}

/** The heads of the listed figures; a click sorts by one, another click the other way around. */
function heads(store: LibraryStore): HTMLElement {
  const head = (name: string) => {
    const column = columnOf(name);
    const mine = () => store.query().sort === name;
    const arrow = () => (mine() ? (store.query().descending ? " ↓" : " ↑") : "");
    const act = () => store.ask({ sort: name, descending: mine() ? !store.query.peek().descending : true });
    const label = () =>
      h("span", {}, column?.short ?? name, arrow(), h("span", { class: "unit" }, column?.unit ?? ""));
    return h(
      "button",
      { type: "button", class: "lib-headed", title: `Sort by: ${column?.label}`, on: { click: act } },
      label,
    );
  };
  const names = computed(() => listedColumns(store.query().sort).join());
  return h("div", { class: "lib-heads", role: "group", "aria-label": "Sort by a figure" }, () =>
    names().split(",").map(head),
  );
}

function indexing(store: LibraryStore): Child {
  const standing = store.standing();
  if (!standing || standing.ended)
    return standing?.trouble ? h("p", { class: "wrong" }, standing.trouble) : null;
  const [done, total] = [() => store.standing()?.done ?? 0, () => store.standing()?.total ?? null];
  return h(
    "div",
    { class: "lib-indexing" },
    h("span", { class: "muted" }, () => `Reading files: ${done()} of ${total() ?? "…"}`),
    progress("Reading files", done, total),
  );
}

const NAMES: Readonly<Record<string, string>> = {
  text: "the words",
  kinds: "the type",
  origins: "where it is from",
};

/** Where no row is left: what to loosen, or how to get buttons. */
function nothing(store: LibraryStore): Child {
  const { positions, without } = store.found();
  store.grown();
  if (positions.length || !store.rows.length) return onlyBuiltin(store);
  const loosen = Object.entries(without).sort((a, b) => b[1] - a[1]);
  return h(
    "div",
    { class: "lib-nothing" },
    empty(
      "No button matches",
      loosen.length > 1 ? "Removing one of these gives results:" : "Loosen a filter:",
      loosen.map(([name, count]) =>
        button({
          label: `Without ${NAMES[name] ?? columnOf(name)?.short.toLowerCase() ?? name}: ${count}`,
          act: () => drop(store, name),
        }),
      ),
    ),
  );
}

function drop(store: LibraryStore, name: string): void {
  if (name === "text") store.ask({ text: "" });
  else if (name === "kinds" || name === "origins") store.ask({ [name]: [] });
  else
    store.ask({
      ranges: Object.fromEntries(
        Object.entries(store.query.peek().ranges).filter(([other]) => other !== name),
      ),
    });
}

/** Under the built-in buttons, where no folder was given: how to add one. */
function onlyBuiltin(store: LibraryStore): Child {
  const standing = store.standing();
  if (!standing?.ended || standing.sources > 0 || store.query().text) return null;
  return h(
    "p",
    { class: "lib-more-buttons muted" },
    "These are the built-in buttons and your own. To add measured switches, start the studio with their folders: ",
    h("code", {}, "fdvv studio FOLDER …"),
  );
}
