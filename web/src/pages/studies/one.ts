/** One study: its plan, its people, its end. */

import { address, keepQuery, route } from "../../app/route";
import { computed, empty, h, signal, tabs, untracked } from "../../ui";
import { stateTag } from "./list";
import { peopleView } from "./people";
import { planView } from "./plan";
import { sealView } from "./seal";
import { StudyStore } from "./store";

type Tab = "plan" | "people" | "seal";
const TABS: readonly (readonly [Tab, string])[] = [
  ["plan", "Plan"],
  ["people", "People"],
  ["seal", "Seal and results"],
];

export function studyPage(host: HTMLElement, study: string): void {
  const store = new StudyStore(study);
  const asked = TABS.find(([name]) => name === route.peek().query.get("tab"))?.[0];
  const tab = signal<Tab | null>(asked ?? null);
  const set = (next: Tab) => {
    tab.set(next);
    keepQuery({ tab: next });
  };
  // one value, so that no view is put up for a state that is known no more
  const standing = computed(() => {
    const state = store.detail()?.row.state;
    return state ? `${state} ${tab() ?? (state === "draft" ? "plan" : "people")}` : "";
  });
  const there = computed(() => standing() !== "");
  const which = (): Tab => (standing().split(" ")[1] ?? "plan") as Tab;
  const body = (which: Tab) =>
    which === "plan"
      ? planView(store, () => set("people"))
      : which === "people"
        ? peopleView(store, () => set("plan"))
        : sealView(store);
  // a view stands as long as its tab and the study's state do: what is typed in it outlives the news
  const view = () => {
    const tab = which();
    return untracked(() => body(tab));
  };
  host.append(
    h("div", { class: "sts-page" }, () =>
      there()
        ? [
            heading(store),
            tabs({ label: "Study", tabs: TABS, value: which, set }),
            h("div", { class: "sts-page", role: "tabpanel", "aria-label": "Study" }, view),
          ]
        : waiting(store),
    ),
  );
}

function waiting(store: StudyStore): HTMLElement {
  const wrong = store.wrong();
  return wrong
    ? empty("This study cannot be shown", wrong, h("a", { href: address("studies") }, "All studies"))
    : h("p", { class: "muted" }, "…");
}

function heading(store: StudyStore): HTMLElement {
  const row = () => store.detail()?.row;
  return h(
    "div",
    { class: "row spread" },
    h(
      "div",
      { class: "row" },
      h("h1", {}, () => row()?.title || store.study),
      () => stateTag(row()?.state ?? "draft"),
      h(
        "span",
        { class: "muted" },
        () => `${row()?.kind ?? ""}, ${row()?.people ?? 0} of ${row()?.planned ?? 0} people`,
      ),
    ),
    h("a", { href: address("studies") }, "All studies"),
  );
}
