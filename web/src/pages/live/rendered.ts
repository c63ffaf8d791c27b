/** Target and rendered forces of the last presses at one speed. */

import { type Brush, Plot, palette, type Range, rangeOf, series, type View } from "../../draw";
import { type Child, choice, h, signal } from "../../ui";
import { listOf, speedsKey, swatch } from "./converge";
import { watched } from "./jobs";
import type { NumberedPress } from "./picture";
import { spans } from "./spans";

const SHOWN = 3;
const BARE_DASH = [1, 3];
/** Speed that is looked at; "last" follows the presses. */
const chosen = signal("last");

export function renderedPanel(): Child {
  const speeds = speedsKey();
  return () => view(listOf(speeds()));
}

function view(speeds: readonly number[]): HTMLElement {
  chosen.set("last");
  const plot = new Plot({
    label: "Force over displacement: target, and rendered in the last presses",
    x: { label: "displacement", unit: "mm" },
    y: { label: "force", unit: "cN" },
    whole,
    still: draw,
    zoom: true,
    height_px: 300,
  });
  const pick = choice({
    label: "Speed",
    options: [
      ["last", "of the last press"],
      ...speeds.map((v): [string, string] => [String(v), `${v} mm/s`]),
    ],
    value: () => chosen(),
    set: (value) => chosen.set(value),
  });
  const legend = h(
    "span",
    { class: "legend" },
    swatch(0, "intended"),
    swatch(1, "rendered, press"),
    swatch(2, "rendered, release"),
    h(
      "span",
      { class: "muted" },
      "Grey: ± 1 JND of force. Dotted grey: without compensation. Bars: where held-out presses would be noticed.",
    ),
  );
  return h("div", { class: "stack" }, h("div", { class: "row spread" }, pick, legend), plot.element);
}

function speed(): number | null {
  const last = watched().picture.presses.at(-1)?.press.velocity_mm_s;
  const first = watched().picture.intended.keys().next().value;
  return chosen() === "last" ? (last ?? first ?? null) : Number(chosen());
}

function lastPresses(velocity_mm_s: number): readonly NumberedPress[] {
  return watched()
    .picture.presses.filter(
      ({ press }) => press.velocity_mm_s === velocity_mm_s && press.felt && press.stage !== "baseline",
    )
    .slice(-SHOWN);
}

/** The last press without compensation, to compare. */
function bare(velocity_mm_s: number): NumberedPress | undefined {
  return watched().picture.presses.findLast(
    ({ press }) => press.velocity_mm_s === velocity_mm_s && press.felt && press.stage === "baseline",
  );
}

function whole(): { x: Range; y: Range } {
  const { intended } = watched().picture;
  const columns = [...intended.values()].flatMap((one) => [one.press_cN, one.release_cN]);
  const x = [...intended.values()][0]?.displacement_mm ?? [0, 4];
  const y = rangeOf(columns, 0.15) ?? { low: 0, high: 100 };
  return { x: { low: 0, high: x.at(-1) as number }, y: { low: Math.min(0, y.low), high: y.high } };
}

function draw(brush: Brush, view_: View): void {
  const velocity_mm_s = speed();
  const wanted = velocity_mm_s === null ? undefined : watched().picture.intended.get(velocity_mm_s);
  if (!wanted || velocity_mm_s === null) return;
  const x = wanted.displacement_mm.map((mm) => view_.x.px(mm));
  const line = (values: readonly (number | null)[], n: number, opacity: number, width_px: number) => {
    const { colour, dash } = n < 0 ? { colour: palette().muted, dash: BARE_DASH } : series(n);
    const y = values.map((cN) => (cN === null ? NaN : view_.y.px(cN)));
    brush.line(x, y, { colour, dash, opacity, width_px });
  };
  band(brush, view_, x, wanted.press_cN, wanted.press_jnd_cN ?? []);
  band(brush, view_, x, wanted.release_cN, wanted.release_jnd_cN ?? []);
  markNoticed(brush, view_, velocity_mm_s);
  const before = bare(velocity_mm_s)?.press.felt;
  line(before?.press_cN ?? [], -1, 1, 1.5);
  line(before?.release_cN ?? [], -1, 1, 1.5);
  const presses = lastPresses(velocity_mm_s);
  presses.forEach(({ press }, i) => {
    const opacity = (i + 1) / presses.length;
    line(press.felt?.press_cN ?? [], 1, opacity, 1.5);
    line(press.felt?.release_cN ?? [], 2, opacity, 1.5);
  });
  line(wanted.press_cN, 0, 1, 2);
  line(wanted.release_cN, 0, 0.6, 2);
}

/** One just noticeable difference on either side of a curve; nothing for jobs of older versions. */
function band(
  brush: Brush,
  view_: View,
  x: readonly number[],
  force_cN: readonly number[],
  jnd_cN: readonly number[],
): void {
  if (jnd_cN.length !== force_cN.length) return;
  const edge = (sign: number) => force_cN.map((cN, i) => view_.y.px(cN + sign * (jnd_cN[i] as number)));
  const around = [...edge(-1), ...edge(1).reverse()];
  brush.area([...x, ...[...x].reverse()], around, { colour: palette().muted, opacity: 0.18 });
}

/** Bars at the bottom of the plot, press above release, where most held-out presses would be noticed. */
function markNoticed(brush: Brush, view_: View, velocity_mm_s: number): void {
  const found = watched().picture.outcomes.find((one) => one.stage === "probe")?.noticed ?? [];
  const { top, height } = view_.box;
  for (const curve of found.filter((one) => one.velocity_mm_s === velocity_mm_s)) {
    const n = curve.stroke === "press" ? 1 : 2;
    const y = top + height - (n === 1 ? 9 : 3);
    for (const [from, to] of spans(curve.displacement_mm, curve.noticed_ratio))
      brush.line([view_.x.px(from), view_.x.px(to)], [y, y], { colour: series(n).colour, width_px: 4 });
  }
}
