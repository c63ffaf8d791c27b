/** The right half: plot, legend, and what belongs to the chosen tab. */

import { button, choice, computed, h, tabs, toggle, toolbar } from "../../ui";
import { about } from "./about";
import { alikeList } from "./alike";
import { speedText } from "./columns";
import { speeds } from "./curves";
import { exportCsv, exportPng, exportSvg, MOST_SHARED, share } from "./export";
import { landmarkTable } from "./landmarks";
import { legend } from "./legend";
import { Overlay } from "./overlay";
import type { TabName, ViewName } from "./state";
import type { LibraryStore } from "./store";

const VIEWS: readonly (readonly [ViewName, string])[] = [
  ["force", "Force"],
  ["slope", "Slope"],
  ["work", "Work"],
];
const TABS: readonly (readonly [TabName, string])[] = [
  ["landmarks", "Landmarks"],
  ["alike", "Similar"],
  ["about", "About"],
];

const MARKS = "● peak  ○ valley  ■ actuation  □ reset";

export function compare(store: LibraryStore): HTMLElement {
  const overlay = new Overlay(store);
  const tab = () => store.shown().tab;
  const below: readonly (readonly [TabName, HTMLElement])[] = [
    ["landmarks", landmarkTable(store)],
    ["alike", alikeList(store)],
    ["about", about(store)],
  ];
  return h(
    "section",
    { class: "panel lib-compare", "aria-label": "Compared buttons" },
    controls(store, overlay),
    h("div", { class: "lib-plot" }, overlay.plot.element, preview(overlay)),
    legend(store, overlay),
    tabs({ label: "Below the curves", tabs: TABS, value: tab, set: (next) => store.show({ tab: next }) }),
    h(
      "div",
      { class: "lib-below" },
      below.map(([name, element]) => h("div", { class: "lib-tab", hidden: () => tab() !== name }, element)),
    ),
  );
}

function controls(store: LibraryStore, overlay: Overlay): HTMLElement {
  const shown = store.shown;
  return h(
    "div",
    { class: "lib-controls" },
    tabs({
      label: "What is drawn over displacement",
      tabs: VIEWS,
      value: () => shown().view,
      set: (view) => store.show({ view }),
    }),
    h("span", { class: "grow" }),
    takeAlong(store, overlay),
    toolbar(
      "Curves",
      toggle({ label: "━ Press", value: () => shown().press, set: (press) => store.show({ press }) }),
      toggle({
        label: "─ Release",
        hint: "Thinner and paler",
        value: () => shown().release,
        set: (release) => store.show({ release }),
      }),
      toggle({
        label: "Landmarks",
        hint: MARKS,
        value: () => shown().marks,
        set: (marks) => store.show({ marks }),
      }),
      toggle({
        label: "Loss",
        value: () => shown().loss,
        set: (loss) => store.show({ loss }),
        hint: "Fill the hysteresis loop",
      }),
      speedChoice(store),
    ),
    h("p", { class: "lib-underline muted", hidden: () => !shown().marks || shown().view !== "force" }, MARKS),
  );
}

function takeAlong(store: LibraryStore, overlay: Overlay): HTMLElement {
  const nothing = () => overlay.drawn().length === 0;
  return toolbar(
    "Export",
    button({ label: "Fit", kind: "quiet", hint: "Fit the whole curves", act: () => overlay.plot.fit() }),
    button({ label: "PNG", kind: "quiet", disabled: nothing, act: () => exportPng(overlay) }),
    button({ label: "SVG", kind: "quiet", disabled: nothing, act: () => exportSvg(overlay) }),
    button({
      label: "Share",
      kind: "quiet",
      hint: "Save a page of one to six buttons that opens anywhere",
      disabled: () => nothing() || store.shown().overlay.length > MOST_SHARED,
      act: () => share(store.shown.peek()),
    }),
    button({
      label: "CSV",
      kind: "quiet",
      disabled: nothing,
      act: () => exportCsv(overlay, store.shown.peek().view),
    }),
  );
}

/** Shown where some button was measured at several speeds. */
function speedChoice(store: LibraryStore): () => HTMLElement | null {
  const known = computed(() => {
    const { overlay } = store.shown();
    return speeds(overlay.flatMap((id) => store.buttons().get(id) ?? [])).join();
  });
  const value = () => String(store.shown().velocity_mm_s ?? "");
  return () => {
    const all = known().split(",").filter(Boolean);
    if (all.length < 2) return null;
    const options = [
      ["", "slowest speeds"] as const,
      ...all.map((v) => [v, `nearest to ${speedText(Number(v))}`] as const),
    ];
    return choice({
      label: "Speed",
      bare: true,
      options,
      value,
      set: (text) => store.show({ velocity_mm_s: text ? Number(text) : null }),
    });
  };
}

/** Says which curve is dotted: the one that the keys of the list are at. */
function preview(overlay: Overlay): HTMLElement {
  return h("p", { class: "lib-preview muted", "aria-live": "polite" }, () => {
    const found = overlay.preview();
    return found ? `dotted: ${found.name} (Space keeps it)` : null;
  });
}
