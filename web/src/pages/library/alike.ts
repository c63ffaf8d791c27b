/** Buttons that feel like one: the nearest of the shelf, with what makes them differ. */

import { call } from "../../net";
import type { LibraryAlike } from "../../net/messages";
import { button, effect, h, signal, tell } from "../../ui";
import { figure } from "./columns";
import type { LibraryStore } from "./store";

/** Return the id of the button that likeness is asked of: the reference, else the row that the keys are at. */
export function asksOf(store: LibraryStore): string | null {
  return store.shown().reference ?? store.activeId();
}

export function alikeList(store: LibraryStore): HTMLElement {
  const found = signal<{ readonly id: string; readonly alike: readonly LibraryAlike[] } | null>(null);
  effect(() => {
    const id = store.shown().tab === "alike" ? asksOf(store) : null;
    store.grown();
    if (id === null) return;
    const stop = new AbortController();
    call("library.like", { id, limit: 20 }, stop.signal).then(
      ({ alike }) => found.set({ id, alike }),
      (error: unknown) => (error instanceof DOMException ? undefined : tell(error)),
    );
    return () => stop.abort();
  });
  const name = (id: string) => store.rows.names[store.rows.at(id)] ?? id;
  return h(
    "div",
    { class: "lib-scroll", tabindex: 0, role: "region", "aria-label": "Similar buttons" },
    () => {
      const now = found();
      if (!now) return h("p", { class: "muted lib-hint" }, "Choose a button to find similar ones.");
      return [
        h(
          "p",
          { class: "row spread" },
          h(
            "span",
            {},
            "Nearest to ",
            h("strong", {}, name(now.id)),
            ", in just noticeable differences (JND)",
          ),
          button({
            label: "Sort the list by similarity",
            act: () => store.ask({ like: now.id, sort: "match", descending: false }),
          }),
        ),
        table(store, now.alike),
      ];
    },
  );
}

function table(store: LibraryStore, alike: readonly LibraryAlike[]): HTMLElement {
  const heads = ["Button", "Type", "Distance", "Force", "Shape", "Landmarks", ""];
  return h(
    "table",
    {},
    h(
      "thead",
      {},
      h(
        "tr",
        {},
        heads.map((text, i) =>
          h(
            "th",
            { scope: "col", class: i > 1 && i < 6 ? "number" : "" },
            text || h("span", { class: "visually-hidden" }, "Compare"),
          ),
        ),
      ),
    ),
    h(
      "tbody",
      {},
      alike.map((one) => line(store, one)),
    ),
  );
}

function line(store: LibraryStore, one: LibraryAlike): HTMLElement {
  const inside = () => store.shown().overlay.includes(one.row.id);
  const jnd = (value: number) => h("td", { class: "number" }, figure(value, 1));
  return h(
    "tr",
    {},
    h("td", { title: one.row.collection }, one.row.name),
    h("td", {}, one.row.kind),
    jnd(one.distance_jnd),
    jnd(one.force_jnd),
    jnd(one.shape_jnd),
    jnd(one.landmarks_jnd),
    h(
      "td",
      {},
      button({
        label: `Compare ${one.row.name}`,
        glyph: "+",
        kind: "quiet",
        pressed: inside,
        act: () => store.toggle(one.row.id),
      }),
    ),
  );
}
