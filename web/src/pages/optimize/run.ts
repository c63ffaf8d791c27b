/** One run: played, compared, timed. */

import { address, keepQuery, route } from "../../app/route";
import { computed, empty, h, signal, tabs } from "../../ui";
import { board } from "./board";
import { designPanel } from "./design";
import { preferView } from "./prefer";
import { progressPanel } from "./progress";
import { resultView } from "./result";
import { simulatedPanel } from "./simulated";
import { RunStore } from "./store";
import { timingPanel } from "./timing";

type Tab = "play" | "result" | "timing";
const TABS: readonly (readonly [Tab, string])[] = [
  ["play", "Play"],
  ["result", "Result"],
  ["timing", "Timing"],
];

export function runPage(host: HTMLElement, run: number): void {
  const store = new RunStore(run);
  const asked = route.peek().query.get("tab") as Tab | null;
  const tab = signal<Tab>(TABS.find(([name]) => name === asked)?.[0] ?? "play");
  const set = (next: Tab) => {
    tab.set(next);
    keepQuery({ tab: next });
  };
  const there = computed(() => !!store.detail());
  const kind = computed(() => {
    const row = store.detail()?.row;
    return row?.preference ? "prefer" : row?.simulated ? "simulated" : "play";
  });
  host.append(
    h("div", { class: "opt-run-page" }, () =>
      there()
        ? kind() === "prefer"
          ? comparing(store, tab, set)
          : whole(store, tab, set, kind() === "simulated")
        : waiting(store),
    ),
  );
}

function waiting(store: RunStore): HTMLElement {
  const wrong = store.wrong();
  const back = h("a", { href: address("optimize") }, "All runs");
  return wrong ? empty("This run cannot be shown", wrong, back) : h("p", { class: "muted" }, "…");
}

function whole(store: RunStore, tab: () => Tab, set: (tab: Tab) => void, simulated: boolean): HTMLElement {
  const played = board(store);
  const quiet = () => (played.busy() ? "opt-quiet" : "");
  const first = simulated ? simulatedPanel(store) : played.element;
  return h(
    "div",
    { class: "opt-run-page" },
    h(
      "div",
      { class: () => `row spread ${quiet()}` },
      heading(store),
      h("a", { href: address("optimize") }, "All runs"),
    ),
    h(
      "div",
      { class: quiet },
      tabs({ label: "Run", tabs: simulated ? TABS.slice(0, 2) : TABS, value: tab, set }),
    ),
    h(
      "div",
      { class: "opt-run-page", role: "tabpanel", "aria-label": "Play", hidden: () => tab() !== "play" },
      first,
      h(
        "div",
        { class: () => `opt-two ${quiet()}` },
        progressPanel(store, played.scores),
        designPanel(store),
      ),
    ),
    () => (tab() === "result" ? resultView(store) : tab() === "timing" ? timingPanel(played.play) : null),
  );
}

/** A run in which two are compared: nothing in it is timed. */
function comparing(store: RunStore, tab: () => Tab, set: (tab: Tab) => void): HTMLElement {
  const shown = () => (tab() === "result" ? "result" : "play");
  return h(
    "div",
    { class: "opt-run-page" },
    h("div", { class: "row spread" }, heading(store), h("a", { href: address("optimize") }, "All runs")),
    tabs({
      label: "Run",
      tabs: [
        ["play", "Compare"],
        ["result", "Result"],
      ],
      value: shown,
      set,
    }),
    () => (shown() === "result" ? resultView(store) : preferView(store)),
  );
}

function heading(store: RunStore): HTMLElement {
  const said = () => {
    const row = store.detail()?.row;
    const what = row?.preference ? "preference" : row?.level;
    const others = store.detail()?.others;
    return row
      ? `${row.engine}, ${what}, seed ${store.detail()?.seed ?? 0}${others ? `; begun from ${others}` : ""}`
      : "";
  };
  return h(
    "div",
    { class: "row" },
    h("h1", {}, () => store.detail()?.row.title ?? ""),
    h("span", { class: "muted" }, said),
    () => (store.detail()?.row.simulated ? h("span", { class: "tag simulated" }, "simulated") : null),
  );
}
