/** The view of a job that learns or judges: convergence, what was felt, every press, the outcome. */

import type { JobOutcome } from "../../net";
import { computed, h, panel, signal, tabs, type Child } from "../../ui";
import { convergence, convergenceLegend, errorTable } from "./converge";
import { feltPanel } from "./felt";
import { watched } from "./jobs";
import type { Stage } from "./picture";
import { pressTable } from "./presses";
import { pressCue } from "./presscue";

type Part = "learn" | "judge";
/** What a person has chosen to see; null follows the work. */
const chosen = signal<Part | null>(null);

export function learnView(): Child {
  chosen.set(null);
  const shown = computed(part);
  return [
    pressCue(),
    panel("Convergence", partTabs(), () => stageView(shown() === "judge" ? "probe" : "compensate")),
    h("div", { class: "two" }, panel("Intended and felt", feltPanel()), outcomes()),
    panel("Presses", pressTable()),
  ];
}

function part(): Part {
  const { presses } = watched().picture;
  const judged = presses.at(-1)?.press.stage === "probe";
  return chosen() ?? (judged && !presses.some((one) => one.press.stage === "compensate") ? "judge" : "learn");
}

function partTabs(): HTMLElement {
  return tabs<Part>({
    label: "Part of the work",
    tabs: [
      ["learn", "While it learns"],
      ["judge", "On fresh presses"],
    ],
    value: part,
    set: (value) => chosen.set(value),
  });
}

function stageView(stage: Stage): Child {
  const some = () => watched().picture.presses.some((one) => one.press.stage === stage && !one.press.skipped);
  const none = stage === "probe" ? "Not judged yet: fresh presses come once it has learned." : "No press yet.";
  return h(
    "div",
    { class: "stack" },
    convergenceLegend(stage),
    convergence(stage),
    h("details", {}, h("summary", {}, "Figures"), () => (some() ? errorTable(stage, "Errors of every curve") : h("p", { class: "muted" }, none))),
  );
}

function outcomes(): HTMLElement {
  return panel("What came out", () => {
    const found = watched().picture.outcomes;
    return found.length ? found.map(outcome) : h("p", { class: "muted" }, "Told once the learning, and then the judging, is over.");
  });
}

function outcome(one: JobOutcome): HTMLElement {
  const simulated = one.simulated ? h("span", { class: "tag simulated" }, "simulated") : null;
  const counted = `${one.presses} presses${one.skipped ? `, ${one.skipped} of them not used` : ""}`;
  return h(
    "div",
    { class: "outcome" },
    h("h3", {}, one.stage === "probe" ? "Judged on fresh presses" : "Learned", simulated),
    h("p", {}, `${one.sentence.replace(/\+-/g, "±")}. ${counted}.`),
  );
}
