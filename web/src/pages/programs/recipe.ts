/** How the numbers of a recipe are named, bounded and written. */

import type { ProgramParameter } from "../../net/messages";

const UNITS: readonly (readonly [string, string])[] = [
  ["_mm_s", "mm/s"],
  ["_per_m_s", "per m/s"],
  ["_mm", "mm"],
  ["_cN", "cN"],
  ["_ms", "ms"],
];

/** Return the words and the unit of a parameter's name, whose last part is the unit. */
export function wordsOf(name: string): { readonly label: string; readonly unit: string } {
  const [ending, unit] = UNITS.find(([held]) => name.endsWith(held)) ?? ["", ""];
  const label = name.slice(0, name.length - ending.length).replaceAll("_", " ");
  return { label: label.charAt(0).toUpperCase() + label.slice(1), unit };
}

/** Return a step that suits a range. */
export function stepOf(parameter: ProgramParameter): number {
  if (parameter.whole) return parameter.high > 100 ? 10 : 1;
  return parameter.high - parameter.low > 20 ? 5 : 0.05;
}

/** Return a value within the bounds of a parameter. */
export function within(value: number, { low, high, whole }: ProgramParameter): number {
  return Math.min(high, Math.max(low, whole ? Math.round(value) : value));
}

/** Write a bound. */
export function tidy(value: number): string {
  return String(Math.round(value * 1000) / 1000);
}
