/** Where the page is: a section, the job that is looked at, the button that work is asked for, all in the address. */

import { address, go, route } from "../../app/route";
import type { JobRow } from "../../net";

export type Section = "compensate" | "capture" | "tune" | "device";
export const SECTIONS: Readonly<Record<Section, string>> = {
  compensate: "Compensate",
  capture: "Capture",
  tune: "Tune",
  device: "Device",
};

export function section(): Section {
  const { id } = route();
  return id in SECTIONS ? (id as Section) : "compensate";
}

/** The job that is looked at; empty where a new one is set up. */
export function shownJob(): string {
  return route().query.get("job") ?? "";
}

export function sectionOf(row: JobRow): Exclude<Section, "device"> {
  return row.kind === "probe" ? "compensate" : row.kind;
}

export function jobAddress(row: JobRow): string {
  return address("live", sectionOf(row), { job: row.job });
}

export function goToSection(name: Section): void {
  go("live", name);
}
