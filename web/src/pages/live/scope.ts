/** What a device tells of its ticks: kept as bins of one pixel column each, the least and the most of all in it. */

import type { ScopeFrame } from "../../net";

/** The least and the most of a bin; NaN where there is no sensor. */
type Span = readonly [low: number, high: number];

export interface Bin {
  readonly bin: number;
  readonly displacement_mm: Span;
  readonly force_cN: Span;
  readonly commanded_cN: Span;
  readonly state: number;
  /** The command was cut to a limit. */
  readonly cut: boolean;
}

export interface ScopeBins {
  readonly bin_s: number;
  readonly bins: readonly Bin[];
}

/** Return the bins with new ones, without those that are out of sight; bins of another width are not taken. */
export function withBins(kept: ScopeBins, frame: ScopeFrame, most: number): ScopeBins {
  if (frame.bin_s !== kept.bin_s) return kept;
  const added = frame.bin.map((bin, i) => {
    const span = (low: readonly (number | null)[], high: readonly (number | null)[]): Span => [
      low[i] ?? NaN,
      high[i] ?? NaN,
    ];
    return {
      bin,
      displacement_mm: span(frame.displacement_low_mm, frame.displacement_high_mm),
      force_cN: span(frame.force_low_cN, frame.force_high_cN),
      commanded_cN: span(frame.commanded_low_cN, frame.commanded_high_cN),
      state: frame.state[i] ?? 0,
      cut: frame.cut[i] ?? false,
    };
  });
  const from = (frame.bin.at(-1) ?? 0) - most;
  return { ...kept, bins: [...kept.bins, ...added].filter(({ bin }) => bin > from) };
}

/** The line through least and most of every bin; broken where bins are missing. x is time before the newest, s. */
export function zigzag({ bins, bin_s }: ScopeBins, of: "displacement_mm" | "force_cN" | "commanded_cN") {
  const last = bins.at(-1)?.bin ?? 0;
  const points = bins.flatMap((one, i) => {
    const t_s = (one.bin - last) * bin_s;
    const drawn = one[of].map((value) => ({ t_s, value }));
    return i && one.bin - (bins[i - 1]?.bin ?? 0) > 1 ? [{ t_s, value: NaN }, ...drawn] : drawn;
  });
  return { t_s: points.map((one) => one.t_s), value: points.map((one) => one.value) };
}
