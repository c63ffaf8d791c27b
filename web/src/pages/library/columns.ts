/** The figures of a button as the library shows them: label, unit, decimals. */

import { inUnit } from "../../ui/force";

export interface Column {
  readonly name: string;
  readonly label: string;
  /** Where there is little room. */
  readonly short: string;
  readonly unit: string;
  readonly digits: number;
  /** Subject of the reason that the server gives where the figure is not there. */
  readonly subject: string;
}

const column = (
  name: string,
  label: string,
  short: string,
  unit: string,
  digits: number,
  subject: string,
): Column => ({
  name,
  label,
  short,
  unit,
  digits,
  subject,
});

/** In the order of the table of landmarks. */
export const COLUMNS: readonly Column[] = [
  column("preload_cN", "Force at the end of the contact step", "Preload", "cN", 1, "press"),
  column("peak_cN", "Peak force", "Peak", "cN", 1, "bump"),
  column("peak_mm", "Peak at", "Peak at", "mm", 2, "bump"),
  column("valley_cN", "Valley force", "Valley", "cN", 1, "bump"),
  column("valley_mm", "Valley at", "Valley at", "mm", 2, "bump"),
  column("drop_cN", "Bump (peak minus valley)", "Bump", "cN", 1, "bump"),
  column("snap_ratio", "Snap ratio (bump / peak)", "Snap ratio", "", 2, "bump"),
  column("release_drop_cN", "Bump of the release", "Release bump", "cN", 1, "release"),
  column("actuation_mm", "Actuation at", "Actuation", "mm", 2, "actuation"),
  column("actuation_cN", "Force at actuation", "At actuation", "cN", 1, "actuation"),
  column("reset_mm", "Reset at", "Reset", "mm", 2, "reset"),
  column("travel_mm", "Travel", "Travel", "mm", 2, "press"),
  column("bottom_out_cN", "Force at bottom-out", "Bottom-out", "cN", 1, "press"),
  column("pre_slope_cN_mm", "Mean slope before the peak", "Slope before", "cN/mm", 1, "press"),
  column("post_slope_cN_mm", "Mean slope over the last quarter", "Slope after", "cN/mm", 1, "press"),
  column("work_mJ", "Work of the press", "Work", "mJ", 2, "press"),
  column("loss_mJ", "Work lost (hysteresis)", "Loss", "mJ", 2, "release"),
];

/** Terms of the glossary that explain a figure. */
export const TERMS: Readonly<Record<string, { readonly term: string }>> = {
  preload_cN: { term: "preload" },
  peak_cN: { term: "peak" },
  valley_cN: { term: "valley" },
  drop_cN: { term: "bump" },
  snap_ratio: { term: "snap ratio" },
  actuation_mm: { term: "actuation" },
  reset_mm: { term: "reset" },
  travel_mm: { term: "travel" },
  bottom_out_cN: { term: "bottom-out" },
  loss_mJ: { term: "hysteresis" },
};

const BY_NAME = new Map(COLUMNS.map((one) => [one.name, one]));

export function columnOf(name: string): Column | undefined {
  return BY_NAME.get(name);
}

/** Those that are filters from the start, and those behind "More". */
export const FILTERS = [
  "peak_cN",
  "drop_cN",
  "actuation_mm",
  "travel_mm",
  "bottom_out_cN",
  "snap_ratio",
] as const;
export const MORE_FILTERS = [
  "preload_cN",
  "peak_mm",
  "release_drop_cN",
  "pre_slope_cN_mm",
  "post_slope_cN_mm",
  "work_mJ",
  "loss_mJ",
] as const;

/** Those that every row of the list shows. */
export const LISTED = ["peak_cN", "drop_cN", "bottom_out_cN", "travel_mm"] as const;

export function figure(value: number | null | undefined, digits: number, unit = ""): string {
  return value === null || value === undefined || !Number.isFinite(value) ? "–" : inUnit(value, unit, digits);
}

/** Return the reason why a figure is not there, as the server says it. */
export function whyNot(why: readonly string[], of: Column): string {
  const found = why.find((line) => line.startsWith(`${of.subject}: `));
  return found ? found.slice(of.subject.length + 2) : "not known";
}

/** Say at what speed a stroke was measured. */
export function speedText(velocity_mm_s: number | null | undefined): string {
  if (velocity_mm_s === null || velocity_mm_s === undefined) return "speed not stated";
  return `${Number(velocity_mm_s.toPrecision(3))} mm/s`;
}
