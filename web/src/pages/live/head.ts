/** The head of a job's view: what it is, how far, what went wrong, and what can be done now. */

import { go } from "../../app/route";
import type { JobResult, JobRow } from "../../net";
import { button, computed, h, progress, untracked, type Child } from "../../ui";
import { cancelJob, isUnderWay, resumeJob, rowOf, watched } from "./jobs";
import { stateTag } from "./list";
import { goToSection, sectionOf } from "./where";

export function jobHead(job: string): HTMLElement {
  const there = computed(() => rowOf(job) !== null);
  return h("section", { class: "panel job-head", "aria-label": "Job" }, () =>
    there() ? content(job) : h("p", { class: "muted" }, "There is no such job in this project."),
  );
}

function content(job: string): HTMLElement {
  const first = untracked(() => rowOf(job)) as JobRow;
  const row = () => rowOf(job) ?? first;
  const state = computed(() => row().state);
  const made = computed(() => row().results.length);
  const simulated = first.simulated ? h("span", { class: "tag simulated" }, "simulated") : null;
  const bar = progress("Progress", () => row().done, () => row().total || null);
  const failed = () => (state() === "failed" ? "job-line wrong" : "job-line");
  return h(
    "div",
    { class: "stack" },
    h(
      "div",
      { class: "row spread" },
      h("div", { class: "row" }, h("h2", { class: "job-name" }, first.title), simulated, stateTag(state)),
      h("div", { class: "row" }, () => (state(), untracked(() => actions(row())))),
    ),
    h("div", { hidden: () => !isUnderWay(row()) }, bar),
    h("p", { class: failed, role: "status" }, () => lineOf(row())),
    notices(),
    () => (made(), untracked(() => results(row()))),
  );
}

function lineOf(row: JobRow): string {
  const counted = row.total ? `${row.done} of ${row.total}` : "";
  if (row.line) return [counted, row.line].filter(Boolean).join(": ");
  return [isUnderWay(row) ? counted : "", row.now].filter(Boolean).join(": ");
}

function actions(row: JobRow): Child[] {
  const again = button({ label: "New one", kind: "quiet", act: () => goToSection(sectionOf(row)), hint: "Set up another" });
  if (isUnderWay(row)) {
    return [button({ label: "Stop", kind: "danger", act: () => void cancelJob(row.job), hint: "What was made is kept" })];
  }
  const resume = button({ label: "Go on", kind: "main", act: () => void resumeJob(row.job), hint: "Go on where it stopped" });
  return row.resumable ? [resume, again] : [again];
}

/** What a person should know, the newest last. */
function notices(): Child {
  const found = () => watched().picture.notices;
  return () => (found().length ? h("ul", { class: "job-notices" }, found().slice(-3).map((text) => h("li", {}, text))) : null);
}

const KINDS: Readonly<Record<JobResult["kind"], string>> = {
  actuation: "table",
  measured: "measured on fresh presses",
  rig: "what the rig taught",
  button: "button",
  recording: "recording",
};

function results(row: JobRow): Child {
  if (!row.results.length) return null;
  const button_ = row.results.find((one) => one.kind === "button");
  const kept = row.results.map((one) => h("li", {}, h("span", { class: "muted" }, KINDS[one.kind]), ` ${one.name}`));
  const open = button_ ? button({ label: "Open in the editor", kind: "main", act: () => go("edit", `own:${button_.name}`) }) : null;
  return h("div", { class: "job-results" }, h("h3", {}, "Kept in the project"), h("ul", {}, kept), open);
}
