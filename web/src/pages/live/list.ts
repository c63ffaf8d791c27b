/** All jobs with their state, always in view; and a sign in the header of those that run. */

import "./live.css";
import { headerExtras } from "../../app/header";
import { address } from "../../app/route";
import type { JobRow } from "../../net";
import { computed, empty, h, progress, untracked } from "../../ui";
import { isUnderWay, rowOf, rows } from "./jobs";
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
export function stateTag(state: () => JobRow["state"]): HTMLElement {
  const glyph = h("span", { "aria-hidden": "true" }, () => GLYPHS[state()]);
  return h("span", { class: () => `job-state ${state().replace(" ", "-")}` }, glyph, " ", () => state());
}

export function jobList(): HTMLElement {
  // elements are made anew only when a job is: one that changes under the hand could not be pressed
  const jobs = computed(
    () =>
      rows()
        ?.slice(0, SHOWN)
        .map((row) => row.job)
        .join(" ") ?? "…",
  );
  return h("section", { class: "panel job-list", "aria-label": "Jobs" }, h("h2", {}, "Jobs"), () =>
    listed(jobs()),
  );
}

function listed(jobs: string): HTMLElement {
  if (jobs === "…") return h("p", { class: "muted" }, "…");
  if (!jobs) return empty("No jobs yet", "Choose a task and start it: it appears here and runs by itself.");
  return h("ul", {}, jobs.split(" ").map(item));
}

function item(job: string): HTMLElement {
  const known = untracked(() => rowOf(job)) as JobRow;
  const row = () => rowOf(job) ?? known;
  const bar = progress(
    `Progress of job ${Number(job)}`,
    () => row().done,
    () => row().total || null,
  );
  const current = () => (shownJob() === job ? "true" : null);
  return h(
    "li",
    {},
    h(
      "a",
      { href: jobAddress(known), "aria-current": current },
      h(
        "span",
        { class: "row spread" },
        h("span", { class: "muted" }, `${Number(job)}`),
        stateTag(() => row().state),
      ),
      h("span", { class: "job-title" }, known.title),
      known.simulated ? h("span", { class: "tag simulated" }, "simulated") : null,
      h("span", { hidden: () => !isUnderWay(row()) }, bar),
    ),
  );
}

/** Put a sign of what runs into the header, on every page. */
export function showInHeader(): void {
  const sign = h("a", { class: "job-sign", href: () => signAddress(), hidden: () => !running().length }, () =>
    signText(),
  );
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
