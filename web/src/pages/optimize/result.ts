/** The design that was found beside the one it began with: curves, numbers, landmarks, scores, both to press. */

import { address } from "../../app/route";
import { type Brush, Plot, palette, series, type View } from "../../draw";
import {
  type ButtonLike,
  force_cN,
  type Landmarks,
  landmarks,
  linspace,
  ModelError,
  nearest,
} from "../../math";
import type { FDVVModel } from "../../model";
import { call } from "../../net";
import type { OptimizeDetail } from "../../net/messages";
import {
  button,
  choice,
  computed,
  effect,
  empty,
  h,
  panel,
  type Signal,
  shown,
  signal,
  tell,
  toast,
  untracked,
} from "../../ui";
import { pressStage } from "../press/stage";
import { PUSH_cN } from "./prefer";
import { type Design, named, type RunStore, scoreText } from "./store";

type Side = "start" | "found";
type Models = Readonly<Record<Side, FDVVModel>>;
const SAID: Readonly<Record<Side, string>> = { start: "start", found: "found" };
const ROWS: readonly (keyof Landmarks)[] = [
  "preload_cN",
  "peak_mm",
  "peak_cN",
  "valley_mm",
  "valley_cN",
  "actuation_mm",
  "actuation_cN",
  "bottom_out_cN",
  "work_mJ",
];
const POINTS = 240;

export function resultView(store: RunStore): HTMLElement {
  // "" stands for what the engine recommends
  const picked = signal("");
  const best = signal<Design | null>(null);
  effect(() => {
    if (store.count())
      void call("optimize.best", { run: store.run }).then(({ design }) => best.set(design), tell);
  });
  const models = signal<Models | null>(null);
  const wanted = computed(() =>
    JSON.stringify([store.detail()?.start ?? null, foundDesign(store, picked(), best())]),
  );
  effect(() => {
    const [start, found] = JSON.parse(wanted()) as [Design | null, Design | null];
    models.set(null);
    if (start && found)
      void fetched(store.run, start, found).then(
        (both) => wanted() === JSON.stringify([start, found]) && models.set(both),
        tell,
      );
  });
  return h("div", { class: "opt-result" }, () => {
    const detail = store.detail();
    if (!detail) return h("p", { class: "muted" }, "…");
    if (!store.count())
      return empty(
        "No result yet",
        "After the first trial, the best design so far appears here beside your starting point.",
      );
    const both = models();
    return both
      ? untracked(() => compared(store, detail, both, picked, foundDesign(store, picked(), best()) as Design))
      : h("p", { class: "muted" }, "…");
  });
}

function foundDesign(store: RunStore, picked: string, best: Design | null): Design | null {
  const detail = store.detail();
  if (!detail) return null;
  if (picked) return detail.trials[Number(picked)]?.design ?? null;
  return best ?? detail.trials.find((trial) => trial.front)?.design ?? null;
}

async function fetched(run: number, start: Design, found: Design): Promise<Models> {
  const model = async (design: Design, name: string) =>
    (await call("optimize.model", { run, design, name })).model as unknown as FDVVModel;
  const [one, two] = await Promise.all([model(start, "start"), model(found, "found")]);
  return { start: one, found: two };
}

function compared(
  store: RunStore,
  detail: OptimizeDetail,
  models: Models,
  picked: Signal<string>,
  found: Design,
): HTMLElement {
  const simulated = detail.row.simulated ? h("span", { class: "tag simulated" }, "simulated person") : null;
  return h(
    "div",
    { class: "opt-compared" },
    panel(
      "Best design and start",
      h("div", { class: "row" }, picker(store, detail, picked), simulated),
      overlay(models).element,
      legend(detail),
    ),
    panel("Numbers", numbers(detail, models, found)),
    pressBoth(models),
    keepPanel(store, models.found),
  );
}

function picker(store: RunStore, detail: OptimizeDetail, picked: Signal<string>): HTMLElement {
  const name = store.objective();
  const options = store
    .done()
    .map(
      (one) =>
        [
          String(one.number),
          `trial ${one.number + 1}: ${scoreText(one.scores[name], named(name).unit)}${one.front ? ", on the front" : ""}`,
        ] as const,
    );
  const first = detail.objectives.length === 1 ? "predicted best" : "middle of the front";
  return choice({ label: "Found", options: [["", first], ...options], value: picked, set: picked.set });
}

function overlay(models: Models): Plot {
  const travel = Math.max(models.start.travel_mm, models.found.travel_mm);
  const lines = (["start", "found"] as const).flatMap((side, n) =>
    (["press", "release"] as const).map((stroke) => ({ n, stroke, side, ...line(models[side], stroke) })),
  );
  const most = Math.max(...lines.flatMap((line) => [...line.y_cN].filter(Number.isFinite)));
  const paint = (brush: Brush, view: View) => {
    for (const { n, stroke, x_mm, y_cN } of lines)
      brush.line(x_mm.map(view.x.px), y_cN.map(view.y.px), {
        colour: series(n).colour,
        dash: stroke === "press" ? [] : [6, 4],
        width_px: stroke === "press" ? 2 : 1.25,
      });
    (["start", "found"] as const).forEach((side, n) => {
      const at = models[side].actuation_mm;
      if (at === null) return;
      const x = view.x.px(at);
      brush.line([x, x], [view.box.top + view.box.height - 14, view.box.top + view.box.height], {
        colour: series(n).colour,
        width_px: 3,
      });
      brush.text(
        n ? "▲" : "△",
        { x_px: x, y_px: view.box.top + view.box.height - 20 },
        { colour: series(n).colour, align: "center", halo: palette().surface },
      );
    });
  };
  return new Plot({
    label: "Force over displacement of the best design and the start",
    x: { label: "displacement", unit: "mm" },
    y: { label: "force", unit: "cN" },
    whole: () => ({ x: { low: -0.05, high: travel * 1.02 }, y: { low: 0, high: most * 1.1 } }),
    still: paint,
    height_px: 260,
  });
}

function line(model: ButtonLike, stroke: "press" | "release"): { x_mm: Float64Array; y_cN: Float64Array } {
  const x_mm = linspace(0, model.travel_mm, POINTS);
  const curve = nearest(model, stroke);
  return { x_mm, y_cN: curve ? force_cN(curve, x_mm) : new Float64Array(POINTS).fill(NaN) };
}

function legend(detail: OptimizeDetail): HTMLElement {
  const from = detail.start_name ? ` (near ${detail.start_name})` : "";
  const one = (kind: Side, text: string) =>
    h("span", { class: `opt-key ${kind}` }, h("i", { "aria-hidden": "true" }), text);
  return h(
    "p",
    { class: "opt-legend" },
    one("start", `start${from}`),
    one("found", "found"),
    h("span", { class: "muted" }, "whole line press, dashed release, △ ▲ activation"),
  );
}

function numbers(detail: OptimizeDetail, models: Models, found: Design): HTMLElement {
  const marks = { start: marksOf(models.start), found: marksOf(models.found) };
  const rows = [
    ...(detail.row.preference ? [] : detail.objectives).map(({ name }) =>
      textRow(name, scoreOf(detail, detail.start, name), scoreOf(detail, found, name)),
    ),
    ...detail.parameters.map(({ name }) => row(name, detail.start?.[name] ?? null, found[name] ?? null)),
    ...ROWS.filter((name) => !detail.parameters.some((parameter) => parameter.name === name)).map((name) =>
      row(name, marks.start?.[name] ?? null, marks.found?.[name] ?? null),
    ),
  ];
  return h(
    "div",
    { class: "opt-scroll", tabindex: 0, role: "region", "aria-label": "Numbers of both designs" },
    h(
      "table",
      {},
      h(
        "thead",
        {},
        h(
          "tr",
          {},
          ["", "start", "found", "difference"].map((text) =>
            h(
              "th",
              { scope: "col", class: text ? "number" : "" },
              text || h("span", { class: "visually-hidden" }, "number"),
            ),
          ),
        ),
      ),
      h("tbody", {}, rows),
    ),
  );
}

function marksOf(model: ButtonLike): Landmarks | null {
  try {
    return landmarks(model);
  } catch (error) {
    if (error instanceof ModelError) return null;
    throw error;
  }
}

function row(name: string, start: number | null, found: number | null): HTMLElement {
  const off = start === null || found === null ? "" : shown(found - start, 2);
  return textRow(name, start === null ? "–" : shown(start, 2), found === null ? "–" : shown(found, 2), off);
}

function textRow(name: string, start: string, found: string, off = ""): HTMLElement {
  const { label, unit } = named(name);
  return h(
    "tr",
    {},
    h("th", { scope: "row" }, unit ? `${label}, ${unit}` : label),
    [start, found, off].map((text) => h("td", { class: "number" }, text)),
  );
}

/** Return the score of a design that was tried as it is. */
function scoreOf(detail: OptimizeDetail, design: Design | null, name: string): string {
  const tried = detail.trials.find(
    (one) =>
      design &&
      one.state === "done" &&
      Object.entries(design).every(([key, value]) => one.design[key] === value),
  );
  return tried ? scoreText(tried.scores[name], "") : "not tried";
}

function pressBoth(models: Models): HTMLElement {
  const host = h("div", {});
  const side = signal<Side>("found");
  const stage = pressStage(host, { compact: true, push_cN: PUSH_cN });
  effect(() => {
    const model = models[side()];
    untracked(() => stage.start({ what: { model: { ...model } }, mode: "intended", rig: "paper" }));
  });
  const one = (name: Side) =>
    button({ label: SAID[name], act: () => side.set(name), pressed: () => side() === name });
  return panel(
    "Press them",
    h(
      "div",
      { class: "row", role: "group", "aria-label": "Which one is under the finger" },
      one("start"),
      one("found"),
    ),
    host,
  );
}

function keepPanel(store: RunStore, model: FDVVModel): HTMLElement {
  const name = signal(`run ${store.run} found`);
  const kept = signal<string | null>(null);
  const input: HTMLInputElement = h("input", {
    type: "text",
    id: "opt-keep",
    maxlength: 100,
    value: name.peek(),
    autocomplete: "off",
    on: { input: () => name.set(input.value.trim()) },
  });
  const keep = async () => {
    try {
      const { button: made } = await call("document.create", {
        name: name.peek() || null,
        template: null,
        model: { ...model, name: name.peek() || model.name },
      });
      kept.set(made);
      toast(`Saved as ${made.replace(/^own:/, "")}.`, "done");
    } catch (error) {
      tell(error);
    }
  };
  return panel(
    "Save it",
    h("p", {}, "As your own button: edit it, press it, or render it on a rig."),
    h(
      "div",
      { class: "row" },
      h("label", { for: "opt-keep" }, "Name"),
      input,
      button({ label: "Save as my button", kind: "main", act: () => void keep() }),
      () => {
        const made = kept();
        return made ? h("a", { href: address("edit", made) }, `Edit ${made.replace(/^own:/, "")}`) : null;
      },
    ),
  );
}
