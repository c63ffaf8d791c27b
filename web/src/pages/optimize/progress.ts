/** How a run goes: scores with their errors, the best so far, and every design as a small curve. */

import { type Brush, CanvasBrush, Plot, palette, rangeOf, series, type View } from "../../draw";
import type { OptimizeTrial } from "../../net/messages";
import { effect, h } from "../../ui";
import { curveLine, named, type RunStore, scoreText } from "./store";

const SIZE_px = { width: 72, height: 34 } as const;
const GLYPHS = { suggested: "…", shown: "▶", done: "✓", failed: "×", abandoned: "■" } as const;

export function progressPanel(store: RunStore, scores: () => boolean): HTMLElement {
  const chart = scoreChart(store);
  return h(
    "section",
    { class: "panel opt-progress", "aria-label": "Progress" },
    h(
      "div",
      { class: "row spread" },
      h("h2", {}, "Progress"),
      h("span", { class: "muted" }, () => statusLine(store)),
    ),
    h("div", { hidden: () => !scores() || !store.done().length }, chart.element),
    () => trialTable(store, scores()),
  );
}

function statusLine(store: RunStore): string {
  const row = store.detail()?.row;
  if (!row) return "";
  const best = row.best ? `, best score ${scoreText(row.best, named(store.objective()).unit)}` : "";
  return `${row.spent} of ${row.budget} trials${best}`;
}

/** Score over trial, one standard error either way, and the least so far. */
function scoreChart(store: RunStore): Plot {
  const { label, unit } = named("asynchrony_ms");
  return new Plot({
    label: "Score of every trial with its standard error, and the best so far",
    x: { label: "trial", unit: "" },
    y: { label, unit },
    whole: () => {
      const all = values(store);
      const y = rangeOf(
        [all.map((one) => one.value + one.error), all.map((one) => one.value - one.error)],
        0.1,
      ) ?? { low: 0, high: 1 };
      return {
        x: { low: 0, high: Math.max(8, (store.detail()?.row.budget ?? 8) + 0.5) },
        y: { low: Math.max(0, y.low), high: y.high },
      };
    },
    still: (brush, view) => drawScores(brush, view, store),
    height_px: 210,
  });
}

function values(
  store: RunStore,
): { readonly at: number; readonly value: number; readonly error: number; readonly number: number }[] {
  const name = store.objective();
  return store.done().flatMap((trial) => {
    const score = trial.scores[name];
    return score
      ? [{ at: trial.number + 1, value: score.value, error: score.error ?? 0, number: trial.number }]
      : [];
  });
}

function drawScores(brush: Brush, view: View, store: RunStore): void {
  const all = values(store);
  const [one, two] = [series(0), series(1)];
  let least = Infinity;
  const best = all.flatMap(({ at, value }) => {
    const before = least;
    least = Math.min(least, value);
    return Number.isFinite(before)
      ? [
          [at, before],
          [at, least],
        ]
      : [[at, least]];
  });
  brush.line(
    best.map(([at]) => view.x.px(at as number)),
    best.map(([, y]) => view.y.px(y as number)),
    { colour: two.colour, dash: two.dash, width_px: 2 },
  );
  for (const { at, value, error, number } of all) {
    const x = view.x.px(at);
    brush.line([x, x], [view.y.px(value - error), view.y.px(value + error)], {
      colour: one.colour,
      width_px: 1.5,
    });
    const chosen = store.chosen() === number;
    brush.circle(
      { x_px: x, y_px: view.y.px(value) },
      chosen ? 6 : 4,
      { colour: one.colour },
      { colour: palette().surface, width_px: 1.5 },
    );
  }
}

function trialTable(store: RunStore, scores: boolean): HTMLElement {
  const trials = [...(store.detail()?.trials ?? [])].reverse();
  if (!trials.length) return h("p", { class: "muted" }, "No trials yet. Each design you play appears here.");
  const names = store.detail()?.objectives.map((objective) => objective.name) ?? [];
  return h(
    "div",
    { class: "opt-scroll", tabindex: 0, role: "region", "aria-label": "Trials" },
    h(
      "table",
      {},
      h(
        "thead",
        {},
        h(
          "tr",
          {},
          h("th", { scope: "col" }, "Trial"),
          h("th", { scope: "col" }, "Press"),
          names.map((name) => h("th", { scope: "col", class: "number" }, heading(name))),
          h("th", { scope: "col" }, "State"),
        ),
      ),
      h(
        "tbody",
        {},
        trials.map((trial) => row(store, trial, names, scores)),
      ),
    ),
  );
}

function heading(name: string): string {
  const { label, unit } = named(name);
  return unit ? `${label}, ${unit}` : label;
}

function row(store: RunStore, trial: OptimizeTrial, names: readonly string[], scores: boolean): HTMLElement {
  const chosen = () => store.trial()?.number === trial.number;
  const look = h(
    "button",
    {
      type: "button",
      class: "button quiet",
      "aria-pressed": () => String(chosen()),
      "aria-label": `Look at trial ${trial.number + 1}`,
      on: { click: () => store.chosen.set(trial.number) },
    },
    `${trial.number + 1}`,
  );
  return h(
    "tr",
    {},
    h("th", { scope: "row" }, look),
    h("td", {}, sketch(trial)),
    names.map((name) =>
      h(
        "td",
        { class: "number" },
        scores || trial.state !== "done" ? scoreText(trial.scores[name], "") : "hidden",
      ),
    ),
    h(
      "td",
      { title: trial.reason || null },
      h("span", { "aria-hidden": "true" }, `${GLYPHS[trial.state]} `),
      trial.state,
      trial.front ? ", on the front" : "",
      trial.edited ? ", edited" : "",
      trial.origin === "start" ? ", start" : "",
    ),
  );
}

/** The press of a design, small; all on the same axes. */
function sketch(trial: OptimizeTrial): HTMLCanvasElement {
  const canvas = h("canvas", {
    class: "opt-sketch",
    role: "img",
    "aria-label": `Press of trial ${trial.number + 1}`,
  });
  effect(() => {
    const ratio = devicePixelRatio || 1;
    [canvas.width, canvas.height] = [SIZE_px.width * ratio, SIZE_px.height * ratio];
    const context = canvas.getContext("2d");
    if (!context) return;
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    const { x_mm, y_cN } = curveLine(trial.curve);
    const brush = new CanvasBrush(context);
    const x = (mm: number) => 2 + (mm / Math.max(6.2, x_mm.at(-1) ?? 0)) * (SIZE_px.width - 4);
    const y = (cN: number) => SIZE_px.height - 2 - (cN / Math.max(320, ...y_cN)) * (SIZE_px.height - 4);
    brush.line(x_mm.map(x), y_cN.map(y), { colour: palette().accent, width_px: 1.6 });
    const at = trial.curve.actuation_mm;
    if (at !== null)
      brush.line([x(at), x(at)], [2, SIZE_px.height - 2], { colour: palette().muted, dash: [2, 2] });
  });
  return canvas;
}
