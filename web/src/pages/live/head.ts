/** The head of a job's view: what it is, how far, what went wrong, and what can be done now. */

import { go } from "../../app/route";
import type { JobResult, JobRow } from "../../net";
import { button, h, progress, type Child } from "../../ui";
import { cancelJob, isUnderWay, resumeJob, rowOf, watched } from "./jobs";
import { stateTag } from "./list";
import { goToSection, sectionOf } from "./where";

export function jobHead(job: string): HTMLElement {
  return h("section", { class: "panel job-head", "aria-label": "Job" }, () => {
    const row = rowOf(job);
    return row ? content(row) : h("p", { class: "muted" }, "There is no such job in this project.");
  });
}

function content(row: JobRow): HTMLElement {
  const simulated = row.simulated ? h("span", { class: "tag simulated" }, "simulated") : null;
  const counted = row.total ? `${row.done} of ${row.total}` : "";
  return h(
    "div",
    { class: "stack" },
    h(
      "div",
      { class: "row spread" },
      h("div", { class: "row" }, h("h2", { class: "job-name" }, row.title), simulated, stateTag(row)),
      h("div", { class: "row" }, actions(row)),
    ),
    isUnderWay(row) ? progress("Progress", () => row.done, () => row.total || null) : null,
    h("p", { class: row.state === "failed" ? "job-line wrong" : "job-line", role: "status" }, lineOf(row, counted)),
    notices(),
    results(row),
  );
}

function lineOf(row: JobRow, counted: string): string {
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
