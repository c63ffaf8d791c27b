/** A device's ticks over time: place, or forces. */

import { type Brush, type PlotOptions, palette, type Range, rangeOf, series, type View } from "../../draw";
import { span_s } from "./looking";
import { type Band, type ScopeBins, zigzag } from "./scope";

interface Kind {
  readonly label: string;
  readonly unit: string;
  /** What the axis holds at least. */
  readonly least: Range;
  /** Curves by the number of their series. */
  readonly bands: (bins: ScopeBins) => readonly (readonly [number, Band])[];
}

const KINDS: Readonly<Record<"displacement" | "force", Kind>> = {
  displacement: {
    label: "Displacement of the cap over time",
    unit: "mm",
    least: { low: -0.2, high: 4.5 },
    bands: (bins) => [[0, bins.displacement_mm]],
  },
  force: {
    label: "Forces over time",
    unit: "cN",
    least: { low: 0, high: 100 },
    bands: (bins) => [
      [1, bins.commanded_cN],
      [2, bins.force_cN],
    ],
  },
};

/** shown : the bins, which may be other ones at any time. */
export function scopeOptions(name: keyof typeof KINDS, shown: () => ScopeBins): PlotOptions {
  const { label, unit, least, bands } = KINDS[name];
  return {
    label,
    x: { label: "time before now", unit: "s" },
    y: { label: name, unit },
    whole: () => ({ x: { low: -span_s(), high: 0 }, y: rangeHolding(bands(shown()), least) }),
    still: (brush, view) => {
      const bins = shown();
      for (const [n, band] of bands(bins)) drawBand(brush, view, bins, band, n);
      drawCut(brush, view, bins);
    },
    height_px: 200,
  };
}

function rangeHolding(bands: readonly (readonly [number, Band])[], least: Range): Range {
  const found = rangeOf(bands.flatMap(([, band]) => [band.low, band.high]));
  return found ? { low: Math.min(least.low, found.low), high: Math.max(least.high, found.high) } : least;
}

function drawBand(brush: Brush, view: View, bins: ScopeBins, band: Band, n: number): void {
  const { t_s, value } = zigzag(bins, band);
  // dashes would tear a line that goes up and down in every column
  const style = { colour: series(n).colour, width_px: n === 1 ? 2.5 : 1.3 };
  brush.line(
    t_s.map((t) => view.x.px(t)),
    value.map((v) => view.y.px(v)),
    style,
  );
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
