/** All jobs with their state, always in view; and a sign in the header of those that run. */

import { address } from "../../app/route";
import { headerExtras } from "../../app/shell";
import type { JobRow } from "../../net";
import { empty, h, progress } from "../../ui";
import { isUnderWay, rows } from "./jobs";
import { jobAddress, shownJob } from "./where";

const SHOWN = 30;
const GLYPHS: Readonly<Record<JobRow["state"], string>> = {
  waiting: "…",
  running: "▶",
  "needs you": "!",
  done: "✓",
  cancelled: "■",
  failed: "×",
};

/** A state as a word with a glyph: colour is never the only difference. */
export function stateTag(row: JobRow): HTMLElement {
  const glyph = h("span", { "aria-hidden": "true" }, GLYPHS[row.state]);
  return h("span", { class: `job-state ${row.state.replace(" ", "-")}` }, glyph, ` ${row.state}`);
}

export function jobList(): HTMLElement {
  return h("section", { class: "panel job-list", "aria-label": "Jobs" }, h("h2", {}, "Jobs"), () => listed(rows()));
}

function listed(found: readonly JobRow[] | null): HTMLElement {
  if (!found) return h("p", { class: "muted" }, "…");
  if (!found.length) return empty("No jobs yet", "Choose what to do, and start: it shows up here and goes on by itself.");
  return h("ul", {}, found.slice(0, SHOWN).map(item));
}

function item(row: JobRow): HTMLElement {
  const current = () => (shownJob() === row.job ? "true" : null);
  const bar = isUnderWay(row) ? progress(`Progress of job ${Number(row.job)}`, () => row.done, () => row.total || null) : null;
  return h(
    "li",
    {},
    h(
      "a",
      { href: jobAddress(row), "aria-current": current },
      h("span", { class: "row spread" }, h("span", { class: "muted" }, `${Number(row.job)}`), stateTag(row)),
      h("span", { class: "job-title" }, row.title),
      row.simulated ? h("span", { class: "tag simulated" }, "simulated") : null,
      bar,
    ),
  );
}

/** Put a sign of what runs into the header, on every page. */
export function showInHeader(): void {
  const sign = h("a", { class: "job-sign", href: () => signAddress(), hidden: () => !running().length }, () => signText());
  headerExtras.update((there) => [...there, sign]);
}

function running(): readonly JobRow[] {
  return (rows() ?? []).filter(isUnderWay);
}

function signAddress(): string {
  const first = running().find((row) => row.state === "needs you") ?? running()[0];
  return first ? jobAddress(first) : address("live");
}

function signText(): string {
  const waiting = running().filter((row) => row.state === "needs you").length;
  const count = running().length;
  return `${count === 1 ? "1 job" : `${count} jobs`}${waiting ? ", needs you" : ""}`;
}
