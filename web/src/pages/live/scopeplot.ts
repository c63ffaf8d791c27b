/** A device's ticks over time: place, or forces. */

import { type Brush, type PlotOptions, palette, type Range, rangeOf, series, type View } from "../../draw";
import { span_s } from "./looking";
import { type ScopeBins, zigzag } from "./scope";

interface Kind {
  readonly label: string;
  readonly unit: string;
  /** What the axis holds at least. */
  readonly least: Range;
  /** Curves by the number of their series. */
  readonly curves: readonly (readonly [number, Parameters<typeof zigzag>[1]])[];
}

const KINDS: Readonly<Record<"displacement" | "force", Kind>> = {
  displacement: {
    label: "Displacement of the cap over time",
    unit: "mm",
    least: { low: -0.2, high: 4.5 },
    curves: [[0, "displacement_mm"]],
  },
  force: {
    label: "Forces over time",
    unit: "cN",
    least: { low: 0, high: 100 },
    curves: [
      [1, "commanded_cN"],
      [2, "force_cN"],
    ],
  },
};

/** shown : the bins, which may be other ones at any time. */
export function scopeOptions(name: keyof typeof KINDS, shown: () => ScopeBins): PlotOptions {
  const { label, unit, least, curves } = KINDS[name];
  const whole = () => {
    const found = rangeOf(curves.map(([, of]) => zigzag(shown(), of).value)) ?? least;
    const y = { low: Math.min(least.low, found.low), high: Math.max(least.high, found.high) };
    return { x: { low: -span_s(), high: 0 }, y };
  };
  const still = (brush: Brush, view: View) => {
    for (const [n, of] of curves) {
      const { t_s, value } = zigzag(shown(), of);
      // dashes would tear a line that goes up and down in every column
      const style = { colour: series(n).colour, width_px: n === 1 ? 2.5 : 1.3 };
      brush.line(t_s.map(view.x.px), value.map(view.y.px), style);
    }
    drawCut(brush, view, shown());
  };
  const [x, y] = [
    { label: "time before now", unit: "s" },
    { label: name, unit },
  ];
  return { label, x, y, whole, still, height_px: 200 };
}

/** Mark above the curves where the command was cut to a limit. */
function drawCut(brush: Brush, view: View, { bins, bin_s }: ScopeBins): void {
  const last = bins.at(-1)?.bin ?? 0;
  const { top } = view.box;
  for (const { bin, cut } of bins) {
    const x = view.x.px((bin - last) * bin_s);
    if (cut) brush.line([x, x], [top, top + 6], { colour: palette().warning, width_px: 2 });
  }
}
