/** From numbers with units to pixels and back. */

/** A place in a plot's own units. */
export interface DataPoint {
  readonly x: number;
  readonly y: number;
}

/** A place on the screen, from the plot's upper left corner. */
export interface ScreenPoint {
  readonly x_px: number;
  readonly y_px: number;
}

export interface Range {
  readonly low: number;
  readonly high: number;
}

/** A linear scale; for y the pixels fall as the values rise. */
export interface Scale {
  readonly range: Range;
  readonly from_px: number;
  readonly to_px: number;
  px(value: number): number;
  value(px: number): number;
}

export function linear(range: Range, from_px: number, to_px: number): Scale {
  const span = range.high - range.low || 1;
  const px_per = (to_px - from_px) / span;
  return {
    range,
    from_px,
    to_px,
    px: (value) => from_px + (value - range.low) * px_per,
    value: (px) => range.low + (px - from_px) / px_per,
  };
}

/** By how much more labels than asked for may stand on an axis. */
const MORE = 1.3;

/** Return round values about so far apart that `count` of them fill the range. */
export function ticks(range: Range, count: number): number[] {
  const step = tickStep(range, count);
  const first = Math.ceil(range.low / step - 1e-9);
  const last = Math.floor(range.high / step + 1e-9);
  return Array.from({ length: Math.max(0, last - first + 1) }, (_, i) => (first + i) * step);
}

/** Return the round step: rather a few more labels than hardly any. */
export function tickStep(range: Range, count: number): number {
  const rough = Math.abs(range.high - range.low) / Math.max(1, count) || 1;
  const power = 10 ** Math.floor(Math.log10(rough));
  const factor = [1, 2, 5, 10].find((f) => f * power >= rough / MORE) ?? 10;
  return factor * power;
}

/** Write a tick with the decimals that its step needs. */
export function tickText(value: number, step: number): string {
  const digits = Math.min(12, Math.max(0, -Math.floor(Math.log10(step) + 1e-9)));
  const rounded = Math.abs(value) < step * 1e-6 ? 0 : value;
  return rounded.toFixed(digits).replace("-", "−");
}

/** Return the least range that holds all finite numbers, with some air; null where there are none. */
export function rangeOf(columns: Iterable<ArrayLike<number>>, air_ratio = 0.05): Range | null {
  let [low, high] = [Infinity, -Infinity];
  for (const column of columns) {
    for (let i = 0; i < column.length; i++) {
      const value = column[i] as number;
      if (value < low) low = value;
      if (value > high && value < Infinity) high = value;
    }
  }
  if (!(low <= high)) return null;
  const air = (high - low || Math.abs(high) || 1) * air_ratio;
  return { low: low - air, high: high + air };
}
