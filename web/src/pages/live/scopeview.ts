/** The scope: place and forces over time, as the device tells of its ticks. */

import { type Brush, Plot, palette, type Range, rangeOf, series, type View } from "../../draw";
import { choice, h, panel, signal } from "../../ui";
import { swatch } from "./converge";
import { scope, span_s, standing } from "./looking";
import { type Band, type ScopeBins, zigzag } from "./scope";

const SPANS = ["1", "2", "5", "10", "30"] as const;
const held = signal(false);
let frozen: ScopeBins | null = null;

export function scopePanel(): HTMLElement {
  const options = SPANS.map((s): [string, string] => [s, `${s} s`]);
  const span = choice({
    label: "Time shown",
    options,
    value: () => String(span_s()),
    set: (value) => span_s.set(Number(value)),
  });
  const legend = h(
    "span",
    { class: "legend" },
    swatch(0, "place"),
    swatch(1, "commanded"),
    h("span", { hidden: () => !standing().force_sensor }, swatch(2, "rendered")),
  );
  const place = plot(
    "Displacement of the cap over time",
    "displacement",
    "mm",
    (bins) => [bins.displacement_mm],
    [0],
    { low: -0.2, high: 4.5 },
  );
  const forces = plot(
    "Forces over time",
    "force",
    "cN",
    (bins) => [bins.commanded_cN, bins.force_cN],
    [1, 2],
    { low: 0, high: 100 },
  );
  return panel(
    "Scope",
    h("div", { class: "row spread" }, h("div", { class: "row" }, span, hold()), legend),
    place.element,
    forces.element,
    h("p", { class: "muted", role: "status" }, said),
  );
}

function hold(): HTMLElement {
  const flip = () => {
    frozen = held.peek() ? null : structuredClone(scope.peek().bins);
    held.update((on) => !on);
  };
  return h(
    "button",
    { type: "button", class: "button", "aria-pressed": () => String(held()), on: { click: flip } },
    "Hold",
  );
}

function shownBins(): ScopeBins {
  const { bins } = scope();
  return held() && frozen ? frozen : bins;
}

function said(): string {
  const { bins } = scope();
  if (!bins.bin.length)
    return standing().streams
      ? "Waiting for data."
      : "Only whole presses are shown: this device does not stream.";
  const cut = bins.cut.filter(Boolean).length;
  return `Each column spans the least and the greatest value. State ${bins.state.at(-1) ?? 0}${cut ? `; the command was cut to a limit in ${cut} columns` : ""}.`;
}

type Pick = (bins: ScopeBins) => readonly Band[];

function plot(
  label: string,
  name: string,
  unit: string,
  pick: Pick,
  n: readonly number[],
  least: Range,
): Plot {
  return new Plot({
    label,
    x: { label: "time before now", unit: "s" },
    y: { label: name, unit },
    whole: () => ({ x: { low: -span_s(), high: 0 }, y: rangeHolding(pick(shownBins()), least) }),
    still: (brush, view) => draw(brush, view, pick, n),
    height_px: 200,
  });
}

function rangeHolding(bands: readonly Band[], least: Range): Range {
  const found = rangeOf(bands.flatMap((band) => [band.low, band.high]));
  return found ? { low: Math.min(least.low, found.low), high: Math.max(least.high, found.high) } : least;
}

function draw(brush: Brush, view: View, pick: Pick, n: readonly number[]): void {
  const bins = shownBins();
  pick(bins).forEach((band, i) => {
    const { t_s, value } = zigzag(bins, band);
    // dashes would tear a line that goes up and down in every column
    brush.line(
      t_s.map((t) => view.x.px(t)),
      value.map((v) => view.y.px(v)),
      { colour: series(n[i] as number).colour, width_px: n[i] === 1 ? 2.5 : 1.3 },
    );
  });
  drawCut(brush, view, bins);
}

/** Mark above the curves where the command was cut to a limit. */
function drawCut(brush: Brush, view: View, bins: ScopeBins): void {
  const last = bins.bin.at(-1) ?? 0;
  const colour = palette().warning;
  bins.cut.forEach((cut, i) => {
    const x = view.x.px(((bins.bin[i] as number) - last) * bins.bin_s);
    if (cut) brush.line([x, x], [view.box.top, view.box.top + 6], { colour, width_px: 2 });
  });
}
