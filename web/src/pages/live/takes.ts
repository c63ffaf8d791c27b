/** The view of a capture: what to do next, the moving cue, each take's verdict, the progress of each speed. */

import type { PaceProgress, TakeAsked, TakeEvent } from "../../net";
import { type Child, computed, h, panel, untracked } from "../../ui";
import { beepToggle, cueView } from "./cue";
import { watched } from "./jobs";
import { timeText } from "./motion";

const SHOWN = 60;

export function captureView(): Child {
  return [
    nextPanel(),
    h(
      "div",
      { class: "two" },
      panel("Speeds", () => speedTable(watched().picture.paces)),
      panel("Takes", takesTable()),
    ),
    outcome(),
  ];
}

function nextPanel(): Child {
  const asked = computed(() => watched().picture.takeAsked);
  const cues = computed(() => watched().picture.cues);
  return () => {
    const ask = asked();
    if (!ask) return null;
    const said = h("p", { class: "wanted", role: "status" }, wanted(ask));
    const again = ask.again ? h("p", { class: "wrong" }, `Once more: ${ask.again}.`) : null;
    return panel(
      `Take ${ask.number} of ${ask.total}`,
      said,
      again,
      untracked(() => cued(ask, cues)),
      beepToggle(),
    );
  };
}

function cued(ask: TakeAsked, cues: () => number): Child {
  if (ask.contact_s === null || ask.bottom_s === null) return h("p", { class: "hands-off" }, "Hands off");
  const stroke_s = ask.bottom_s - ask.contact_s;
  return cueView(
    { travel_mm: ask.travel_mm, contact_s: ask.contact_s, stroke_s, length_s: ask.length_s },
    cues,
  );
}

function wanted(ask: TakeAsked): string {
  if (ask.velocity_mm_s === null || ask.contact_s === null || ask.bottom_s === null) {
    return `Take your finger off the button and wait ${timeText(ask.length_s)}.`;
  }
  const how =
    ask.step === "probe"
      ? "Slowly: move the cap down to the stop and back as slowly"
      : "Press down to the stop, then release";
  return `${how}: ${ask.velocity_mm_s} mm/s, ${ask.travel_mm.toFixed(1)} mm in ${timeText(ask.bottom_s - ask.contact_s)}.`;
}

function median(values: readonly number[]): string {
  if (!values.length) return "–";
  const sorted = [...values].sort((a, b) => a - b);
  const [low, high] = [sorted[(sorted.length - 1) >> 1] as number, sorted[sorted.length >> 1] as number];
  return ((low + high) / 2).toFixed(1);
}

function speedTable(paces: readonly PaceProgress[]): HTMLElement {
  if (!paces.length)
    return h("p", { class: "muted" }, "First a rest and a slow probe, then presses at each speed.");
  const heads = ["good", "of", "takes", "missed", "median, mm/s", "least", "most"];
  const row = (speed: PaceProgress) => {
    const speeds = speed.achieved_mm_s;
    const extreme = (pick: (...values: number[]) => number) =>
      speeds.length ? pick(...speeds).toFixed(1) : "–";
    const cells = [
      speed.good,
      speed.wanted,
      speed.made,
      speed.missed,
      median(speeds),
      extreme(Math.min),
      extreme(Math.max),
    ];
    return h(
      "tr",
      {},
      h("th", { scope: "row" }, `${speed.velocity_mm_s} mm/s`),
      cells.map((cell) => h("td", { class: "number" }, cell)),
    );
  };
  return h(
    "table",
    { "aria-label": "Progress of each speed" },
    h(
      "thead",
      {},
      h(
        "tr",
        {},
        h("th", { scope: "col" }, "speed"),
        heads.map((text) => h("th", { scope: "col", class: "number" }, text)),
      ),
    ),
    h("tbody", {}, paces.map(row)),
  );
}

const NAMES = { rest: "at rest", probe: "slow probe", press: "" } as const;

function takesTable(): Child {
  const rows = () => watched().picture.takes.slice(-SHOWN).reverse();
  const line = (take: TakeEvent) =>
    h(
      "tr",
      { class: take.ok ? "" : "skipped" },
      h("td", { class: "number" }, take.number),
      h("td", {}, NAMES[take.step] || `${take.velocity_mm_s ?? "?"} mm/s`),
      h("td", { class: "number" }, take.achieved_mm_s === null ? "–" : take.achieved_mm_s.toFixed(0)),
      h("td", { class: "number" }, take.travel_mm === null ? "–" : take.travel_mm.toFixed(2)),
      h("td", {}, take.ok ? "good" : `${take.reason}${take.missed ? "; too many tries, skipped" : ""}`),
    );
  const heads = ["take", "asked", "achieved, mm/s", "travel, mm"];
  return h(
    "div",
    { class: "press-scroll", tabindex: 0, role: "region", "aria-label": "Takes" },
    h(
      "table",
      { "aria-label": "Takes, newest first" },
      h(
        "thead",
        {},
        h(
          "tr",
          {},
          heads.map((text, i) => h("th", { scope: "col", class: i === 1 ? "" : "number" }, text)),
          h("th", { scope: "col" }, "verdict"),
        ),
      ),
      h("tbody", {}, () => rows().map(line)),
    ),
  );
}

function outcome(): Child {
  return () => {
    const found = watched().picture.outcomes.at(-1);
    if (!found) return null;
    const warnings = (found.warnings ?? []).map((text) => h("li", {}, text));
    const simulated = found.simulated ? h("span", { class: "tag simulated" }, "simulated") : null;
    return panel(
      "The model",
      h("p", {}, `${found.sentence}. `, simulated),
      warnings.length ? h("ul", { class: "job-notices" }, warnings) : null,
    );
  };
}
