/** Rows of numbers as NumPy makes and searches them, so that both sides walk the same grid. */

import type { Numbers } from "./types";

/** Round halves to even, as Python does. */
export function roundHalfEven(x: number): number {
  const low = Math.floor(x);
  const part = x - low;
  if (part !== 0.5) return part < 0.5 ? low : low + 1;
  return low % 2 === 0 ? low : low + 1;
}

/** Return count numbers from start to end, both included. */
export function linspace(start: number, end: number, count: number): Float64Array {
  const out = new Float64Array(count);
  const step = (end - start) / (count - 1);
  for (let i = 0; i < count; i++) out[i] = i * step + start;
  if (count > 1) out[count - 1] = end;
  else if (count === 1) out[0] = start;
  return out;
}

/** Return the first index whose number is not below x, in a rising row. */
export function firstNotBelow(row: Numbers, x: number): number {
  let low = 0;
  let high = row.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (row[middle]! < x) low = middle + 1;
    else high = middle;
  }
  return low;
}

/** Return the first index whose number is above x, in a rising row. */
export function firstAbove(row: Numbers, x: number): number {
  let low = 0;
  let high = row.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (row[middle]! <= x) low = middle + 1;
    else high = middle;
  }
  return low;
}

/** Integrate the polyline through (x, y). */
export function trapezoid(x: Numbers, y: Numbers): number {
  let sum = 0;
  for (let i = 1; i < x.length; i++) sum += 0.5 * (y[i]! + y[i - 1]!) * (x[i]! - x[i - 1]!);
  return sum;
}
