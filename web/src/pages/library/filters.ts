/** Filters: type, origin, ranges. */

import type { ButtonType, Origin } from "../../net/messages";
import { button, h, toggle } from "../../ui";
import { FILTERS, MORE_FILTERS } from "./columns";
import { rangeFilter } from "./histogram";
import { EVERYTHING } from "./state";
import type { LibraryStore } from "./store";

const KINDS: readonly (readonly [ButtonType, string])[] = [
  ["linear", "The force never drops by 4 cN"],
  ["tactile", "The force drops on the press and on the release"],
  ["clicky?", "The force drops at once, or elsewhere on the release; force alone does not show the sound"],
  ["dome?", "The force drops over a long way, then stiffens"],
  ["unclear", "The force drops, but not as in a button"],
];
const ORIGINS: readonly (readonly [Origin, string])[] = [
  ["builtin", "Built in"],
  ["own", "Mine"],
  ["measured", "Measured"],
];

export function filters(store: LibraryStore): HTMLElement {
  const query = store.query;
  const any = () => Object.keys(query().ranges).length + query().kinds.length + query().origins.length > 0;
  const clear = () => store.ask({ ranges: {}, kinds: EVERYTHING.kinds, origins: EVERYTHING.origins });
  const kind = ([value, hint]: (typeof KINDS)[number]) =>
    choiceRow(
      value,
      hint,
      () => store.found().kinds[value] ?? 0,
      () => query().kinds.includes(value),
      (on) =>
        store.ask({
          kinds: on ? [...query.peek().kinds, value] : query.peek().kinds.filter((kind) => kind !== value),
        }),
    );
  const origin = ([value, label]: (typeof ORIGINS)[number]) =>
    choiceRow(
      label,
      label,
      () => store.found().origins[value] ?? 0,
      () => query().origins.includes(value),
      (on) =>
        store.ask({
          origins: on
            ? [...query.peek().origins, value]
            : query.peek().origins.filter((origin) => origin !== value),
        }),
    );
  return h(
    "div",
    { class: "lib-filters-in" },
    h(
      "div",
      { class: "row spread" },
      h("h2", {}, "Filters"),
      button({ label: "Clear", kind: "quiet", act: clear, disabled: () => !any() }),
    ),
    h("fieldset", { class: "lib-kinds" }, h("legend", {}, "Type, by its force"), KINDS.map(kind)),
    h("fieldset", { class: "lib-kinds" }, h("legend", {}, "From"), ORIGINS.map(origin)),
    FILTERS.map((name) => rangeFilter(store, name)),
    h(
      "details",
      { class: "lib-more" },
      h("summary", {}, "More figures"),
      MORE_FILTERS.map((name) => rangeFilter(store, name)),
    ),
  );
}

function choiceRow(
  label: string,
  hint: string,
  count: () => number,
  value: () => boolean,
  set: (on: boolean) => void,
): HTMLElement {
  return h(
    "div",
    { class: "row spread" },
    toggle({ label, hint, value, set }),
    h("span", { class: "muted" }, () => String(count())),
  );
}
