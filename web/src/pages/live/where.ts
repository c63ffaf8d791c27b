/** Where the page is: a section, and the job that is looked at, both in the address. */

import { address, go, route } from "../../app/route";
import type { JobRow } from "../../net";

export type Section = "compensate" | "capture" | "tune" | "device";
export const SECTIONS: readonly (readonly [Section, string])[] = [
  ["compensate", "Compensate"],
  ["capture", "Capture"],
  ["tune", "Tune vibration"],
  ["device", "Device"],
];

export function section(): Section {
  return SECTIONS.find(([name]) => name === route().id)?.[0] ?? "compensate";
}

/** The job that is looked at; empty where a new one is set up. */
export function shownJob(): string {
  return route().query.get("job") ?? "";
}

/** The button that another page asked work for; empty if none did. */
export function askedButton(): string {
  return route().query.get("button") ?? "";
}

export function sectionOf(row: JobRow): Section {
  return row.kind === "probe" ? "compensate" : row.kind;
}

export function jobAddress(row: JobRow): string {
  return address("live", sectionOf(row), { job: row.job });
}

export function goToJob(row: JobRow): void {
  go("live", sectionOf(row), { job: row.job });
}

export function goToSection(name: Section): void {
  go("live", name);
}
