/** What a device tells of its ticks: kept as bins of one pixel column each, the least and the most of all in it. */

import type { ScopeFrame } from "../../net";

/** Columns of one quantity: the least and the most of each bin. */
export interface Band {
  readonly low: number[];
  readonly high: number[];
}

export interface ScopeBins {
  readonly bin_s: number;
  readonly bin: number[];
  readonly displacement_mm: Band;
  readonly force_cN: Band;
  readonly commanded_cN: Band;
  readonly state: number[];
  readonly cut: boolean[];
}

const band = (): Band => ({ low: [], high: [] });

export function emptyBins(bin_s: number): ScopeBins {
  return {
    bin_s,
    bin: [],
    displacement_mm: band(),
    force_cN: band(),
    commanded_cN: band(),
    state: [],
    cut: [],
  };
}

/** Add bins and forget those that are out of sight; bins of another width are not taken. */
export function addBins(kept: ScopeBins, bins: ScopeFrame, most: number): void {
  if (bins.bin_s !== kept.bin_s) return;
  kept.bin.push(...bins.bin);
  kept.displacement_mm.low.push(...bins.displacement_low_mm);
  kept.displacement_mm.high.push(...bins.displacement_high_mm);
  kept.force_cN.low.push(...bins.force_low_cN.map((v) => v ?? NaN));
  kept.force_cN.high.push(...bins.force_high_cN.map((v) => v ?? NaN));
  kept.commanded_cN.low.push(...bins.commanded_low_cN);
  kept.commanded_cN.high.push(...bins.commanded_high_cN);
  kept.state.push(...bins.state);
  kept.cut.push(...bins.cut);
  forget(kept, most);
}

function forget(kept: ScopeBins, most: number): void {
  const last = kept.bin.at(-1);
  if (last === undefined) return;
  const from = kept.bin.findIndex((bin) => bin > last - most);
  if (from <= 0) return;
  const bands = [kept.displacement_mm, kept.force_cN, kept.commanded_cN];
  for (const column of [kept.bin, kept.state, kept.cut, ...bands.flatMap((b) => [b.low, b.high])])
    column.splice(0, from);
}

/** The line through least and most of every bin; broken where bins are missing. x is time before the newest, s. */
export function zigzag(kept: ScopeBins, of: Band): { readonly t_s: number[]; readonly value: number[] } {
  const last = kept.bin.at(-1) ?? 0;
  const t_s: number[] = [];
  const value: number[] = [];
  kept.bin.forEach((bin, i) => {
    const at = (bin - last) * kept.bin_s;
    if (i && bin - (kept.bin[i - 1] as number) > 1) {
      t_s.push(at);
      value.push(NaN);
    }
    t_s.push(at, at);
    value.push(of.low[i] as number, of.high[i] as number);
  });
  return { t_s, value };
}
