/** Values onto a raster, and numbers that people type. */

/** The multiple of a step that is nearest to a value; the value itself where the step is 0. */
export function snapped(value: number, step: number): number {
  if (step <= 0) return value;
  // 3 * 0.1 is not 0.3: the last digits are those of the step
  return Number((Math.round(value / step) * step).toFixed(9));
}

/** A value within bounds. */
export function held(value: number, low: number, high: number): number {
  return Math.min(high, Math.max(low, value));
}

/** The number that a person typed, with a point or a comma; null if it is none. */
export function typed(text: string): number | null {
  const clean = text.trim().replace("−", "-").replace(",", ".");
  if (!/^[+-]?(\d+\.?\d*|\.\d+)(e[+-]?\d+)?$/i.test(clean)) return null;
  const value = Number(clean);
  return Number.isFinite(value) ? value : null;
}
