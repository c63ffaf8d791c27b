/** The view of a job that learns or evaluates: convergence, rendered forces, every press, the outcome. */

import type { CurveNoticed, JobOutcome } from "../../net";
import { type Child, computed, h, panel, signal, tabs } from "../../ui";
import { convergence, convergenceLegend, curveName, curveTable, errorTable } from "./converge";
import { watched } from "./jobs";
import type { Stage } from "./picture";
import { pressCue } from "./presscue";
import { pressTable } from "./presses";
import { renderedPanel } from "./rendered";

type Part = "learn" | "evaluate";
const NOT_ASKED = "not asked for";
/** What a person has chosen to see; null follows the work. */
const chosen = signal<Part | null>(null);

export function learnView(): Child {
  chosen.set(null);
  const shown = computed(part);
  return [
    pressCue(),
    panel("Convergence", partTabs(), () => stageView(shown() === "evaluate" ? "probe" : "compensate")),
    h("div", { class: "two" }, panel("Target and rendered", renderedPanel()), outcomes()),
    panel("Presses", pressTable()),
  ];
}

function part(): Part {
  const { presses } = watched().picture;
  const last = presses.at(-1)?.press.stage;
  const judged = last === "probe" || last === "baseline";
  return (
    chosen() ??
    (judged && !presses.some((press) => press.press.stage === "compensate") ? "evaluate" : "learn")
  );
}

function partTabs(): HTMLElement {
  return tabs<Part>({
    label: "Phase",
    tabs: [
      ["learn", "Learning"],
      ["evaluate", "Held-out presses"],
    ],
    value: part,
    set: (value) => chosen.set(value),
  });
}

function stageView(stage: Stage): Child {
  const some = () =>
    watched().picture.presses.some((press) => press.press.stage === stage && !press.press.skipped);
  const none =
    stage === "probe" ? "Not evaluated yet: held-out presses follow the learning." : "No presses yet.";
  return h(
    "div",
    { class: "stack" },
    convergenceLegend(stage),
    convergence(stage),
    h("details", {}, h("summary", {}, "Figures"), () =>
      some() ? errorTable(stage, "Errors of every curve") : h("p", { class: "muted" }, none),
    ),
  );
}

function outcomes(): HTMLElement {
  return panel("Result", () => {
    const found = watched().picture.outcomes;
    return found.length
      ? found.map(outcome)
      : h("p", { class: "muted" }, "Shown after the learning, and after the evaluation.");
  });
}

function outcome(one: JobOutcome): HTMLElement {
  const simulated = one.simulated ? h("span", { class: "tag simulated" }, "simulated") : null;
  const counted = `${one.presses} presses${one.skipped ? `, ${one.skipped} of them not used` : ""}`;
  return h(
    "div",
    { class: "outcome" },
    h("h3", {}, one.stage === "probe" ? "Evaluated on held-out presses" : "Learned", simulated),
    one.headline ? h("p", { class: "outcome-headline" }, one.headline) : null,
    h("p", {}, `${one.sentence.replace(/\+-/g, "±")}. ${counted}.`),
    one.next_step ? h("p", {}, h("strong", {}, "Next: "), one.next_step) : null,
    one.noticed?.length ? noticedTable(one.noticed) : null,
  );
}

/** How much of each curve a finger would notice, and how the vibration came out. */
function noticedTable(curves: readonly CurveNoticed[]): HTMLElement {
  const percent = (ratio: number) => `${Math.round(100 * ratio)} %`;
  const vibrates = curves.some((curve) => curve.vibration !== NOT_ASKED);
  const fell = (before: string | undefined, after: string) => (before ? `${before} → ${after}` : after);
  const error = (before?: number | null, after?: number | null) =>
    typeof after === "number" ? fell(before?.toFixed(1), after.toFixed(1)) : "–";
  const rows = curves.map((curve) => [
    curveName(curve),
    fell(
      typeof curve.before_ratio === "number" ? percent(curve.before_ratio) : "",
      percent(curve.force_ratio),
    ),
    error(curve.before_mean_cN, curve.mean_cN),
    error(curve.before_max_cN, curve.max_cN),
    ...(vibrates ? [percent(curve.total_ratio), curve.vibration] : []),
  ]);
  const heads = [
    "noticed",
    "mean error, cN",
    "largest, cN",
    ...(vibrates ? ["noticed with vibration", "vibration"] : []),
  ];
  const compared = curves.some((curve) => typeof curve.before_ratio === "number");
  const about = `Noticed: part of the stroke that is off by more than one just noticeable difference${compared ? "; before the arrow, without compensation" : ""}.`;
  return h(
    "div",
    {},
    h("p", { class: "muted" }, about),
    curveTable("What a finger would notice", heads, rows),
  );
}
