/** How the error falls: one small plot for each speed, both strokes, with what a person would just notice. */

import { type Brush, Plot, palette, type Range, rangeOf, series, type View } from "../../draw";
import type { CurveProgress } from "../../net";
import { type Child, computed, h } from "../../ui";
import { watched } from "./jobs";
import { curveKey, type Stage, type StrokeName } from "./picture";

const STROKES: readonly StrokeName[] = ["press", "release"];
/** So many presses are shown at least, on the axis. */
const FEWEST = 4;

/** Plots of all speeds; made anew only when a speed is added. */
export function convergence(stage: Stage): Child {
  const speeds = speedsKey();
  return () =>
    h(
      "div",
      { class: "multiples" },
      listOf(speeds()).map((speed) => multiple(stage, speed)),
    );
}

/** The speeds of the job that is looked at, as a text that changes only when they do. */
export function speedsKey(): () => string {
  return computed(() => [...watched().picture.intended.keys()].sort((a, b) => a - b).join(" "));
}

export function listOf(speeds: string): readonly number[] {
  return speeds.split(" ").filter(Boolean).map(Number);
}

function multiple(stage: Stage, velocity_mm_s: number): HTMLElement {
  const plot = new Plot({
    label: `Error over presses at ${velocity_mm_s} mm/s`,
    x: { label: "press", unit: "" },
    y: { label: "error", unit: "cN" },
    whole: () => ({ x: pressRange(stage, velocity_mm_s), y: errorRange(stage) }),
    still: (brush, view) => drawErrors(brush, view, stage, velocity_mm_s),
    height_px: 190,
  });
  return h("figure", { class: "multiple" }, h("figcaption", {}, `${velocity_mm_s} mm/s`), plot.element);
}

function errorsOf(stage: Stage, stroke: StrokeName, velocity_mm_s: number): readonly number[] {
  return watched().picture.curves.get(curveKey(stage, stroke, velocity_mm_s))?.error_cN ?? [];
}

function pressRange(stage: Stage, velocity_mm_s: number): Range {
  const last = watched().picture.presses.findLast(
    ({ press }) => press.stage === stage && press.velocity_mm_s === velocity_mm_s,
  );
  const made = STROKES.map((stroke) => errorsOf(stage, stroke, velocity_mm_s).length);
  const most = Math.max(FEWEST, last?.press.wanted ?? 0, ...made);
  return { low: 0.5, high: most + 0.5 };
}

/** One range for all speeds, so that they compare by eye. */
function errorRange(stage: Stage): Range {
  const columns = [...watched().picture.curves.entries()]
    .filter(([key]) => key.startsWith(`${stage} `))
    .map(([, curve]) => curve.error_cN);
  return { low: 0, high: Math.max(5, rangeOf(columns)?.high ?? 10) };
}

function drawErrors(brush: Brush, view: View, stage: Stage, velocity_mm_s: number): void {
  drawNoticeable(brush, view, velocity_mm_s);
  STROKES.forEach((stroke, i) => {
    const errors = errorsOf(stage, stroke, velocity_mm_s);
    const { colour, dash } = series(i);
    const at = errors.map((_, n) => view.x.px(n + 1));
    const high = errors.map((error) => view.y.px(error));
    brush.line(at, high, { colour, dash, width_px: 2 });
    errors.forEach((_, n) =>
      brush.circle({ x_px: at[n] as number, y_px: high[n] as number }, 2.5, i ? null : { colour }, {
        colour,
      }),
    );
  });
}

function drawNoticeable(brush: Brush, view: View, velocity_mm_s: number): void {
  const found = watched().picture.intended.get(velocity_mm_s);
  if (!found) return;
  const { muted } = palette();
  const { left, width } = view.box;
  const bound_cN = Math.min(found.noticeable_press_cN, found.noticeable_release_cN);
  const y = view.y.px(bound_cN);
  brush.line([left, left + width], [y, y], { colour: muted, dash: [2, 3] });
  const below = { x_px: left + width - 3, y_px: y - 3 };
  brush.text(`noticed ${bound_cN.toFixed(1)}`, below, {
    colour: muted,
    align: "right",
    base: "bottom",
    size_px: 10,
    halo: palette().surface,
  });
}

/** What the lines mean, in words. */
export function convergenceLegend(stage: Stage): HTMLElement {
  const who =
    stage === "probe" ? "in true displacement, on held-out presses" : "as measured by the rig while learning";
  return h(
    "p",
    { class: "legend" },
    swatch(0, "press"),
    swatch(1, "release"),
    h(
      "span",
      { class: "muted" },
      `Error of each press, ${who}. Dotted: the mean just noticeable difference, 7 % of (force + 30 cN) (after Pang, Tan, Durlach 1991).`,
    ),
  );
}

/** A line as it is drawn, and its name. */
export function swatch(n: number, name: string): HTMLElement {
  return h(
    "span",
    { class: `swatch swatch-${n + 1}` },
    h("span", { class: "swatch-line", "aria-hidden": "true" }),
    name,
  );
}

/** A table of the figures: the same for those who do not see the plots. */
export function errorTable(stage: Stage, label: string): Child {
  return () => {
    const curves = [...watched().picture.curves.entries()]
      .filter(([key]) => key.startsWith(`${stage} `))
      .map(([, c]) => c);
    return curves.length ? table(label, curves) : null;
  };
}

function table(label: string, curves: readonly CurveProgress[]): HTMLElement {
  const sorted = [...curves].sort(
    (a, b) => a.velocity_mm_s - b.velocity_mm_s || a.stroke.localeCompare(b.stroke),
  );
  const figure = (value: number | null | undefined) => value?.toFixed(2) ?? "–";
  const rows = sorted.map((c) => [
    curveName(c),
    c.error_cN.length,
    figure(c.error_cN[0]),
    figure(c.error_cN.at(-1)),
    figure(c.mean_error_cN),
    figure(c.max_error_cN),
  ]);
  return curveTable(label, ["presses", "first, cN", "last, cN", "mean, cN", "largest, cN"], rows);
}

export const curveName = (curve: { velocity_mm_s: number; stroke: string }) =>
  `${curve.velocity_mm_s} mm/s ${curve.stroke}`;

/** A row per curve, its name first. */
export function curveTable(
  label: string,
  heads: readonly string[],
  rows: readonly (readonly (string | number)[])[],
): HTMLElement {
  return h(
    "div",
    { class: "scroll-x", tabindex: "0", role: "group", "aria-label": `${label}, table` },
    h(
      "table",
      { "aria-label": label },
      h(
        "thead",
        {},
        h(
          "tr",
          {},
          ["curve", ...heads].map((text, i) => h("th", { class: i ? "number" : "", scope: "col" }, text)),
        ),
      ),
      h(
        "tbody",
        {},
        rows.map(([name, ...values]) =>
          h(
            "tr",
            {},
            h("th", { scope: "row" }, name),
            values.map((value) => h("td", { class: "number" }, value)),
          ),
        ),
      ),
    ),
  );
}
