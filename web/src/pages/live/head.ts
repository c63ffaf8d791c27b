/** The head of a job's view: what it is, how far, what went wrong, and what can be done now. */

import { go } from "../../app/route";
import type { JobResult, JobRow } from "../../net";
import { button, type Child, computed, h, on, progress, untracked } from "../../ui";
import { cancelJob, isUnderWay, resumeJob, rowOf, watched } from "./jobs";
import { stateTag } from "./list";
import { goToSection, sectionOf } from "./where";

export function jobHead(job: string): HTMLElement {
  const there = computed(() => rowOf(job) !== null);
  return h("section", { class: "panel job-head", "aria-label": "Job" }, () =>
    there() ? content(job) : h("p", { class: "muted" }, "This project has no such job."),
  );
}

function content(job: string): HTMLElement {
  const first = untracked(() => rowOf(job)) as JobRow;
  const row = () => rowOf(job) ?? first;
  const state = computed(() => row().state);
  const made = computed(() => row().results.length);
  const simulated = first.simulated ? h("span", { class: "tag simulated" }, "simulated") : null;
  const bar = progress(
    "Progress",
    () => row().done,
    () => row().total || null,
  );
  const failed = () => (state() === "failed" ? "job-line wrong" : "job-line");
  return h(
    "div",
    { class: "stack" },
    h(
      "div",
      { class: "row spread" },
      h("div", { class: "row" }, h("h2", { class: "job-name" }, first.title), simulated, stateTag(state)),
      h(
        "div",
        { class: "row" },
        on(state, () => actions(row())),
      ),
    ),
    h("div", { hidden: () => !isUnderWay(row()) }, bar),
    h("p", { class: failed, role: "status" }, () => lineOf(row())),
    notices(),
    on(made, () => results(row())),
  );
}

function lineOf(row: JobRow): string {
  const counted = row.total ? `${row.done} of ${row.total}` : "";
  if (row.line) return [counted, row.line].filter(Boolean).join(": ");
  return [isUnderWay(row) ? counted : "", row.now].filter(Boolean).join(": ");
}

function actions(row: JobRow): Child[] {
  const again = button({
    label: "New job",
    kind: "quiet",
    act: () => goToSection(sectionOf(row)),
    hint: "Set up another",
  });
  if (isUnderWay(row)) {
    return [
      button({
        label: "Stop",
        kind: "danger",
        act: () => void cancelJob(row.job),
        hint: "Results so far are kept",
      }),
    ];
  }
  const resume = button({
    label: "Resume",
    kind: "main",
    act: () => void resumeJob(row.job),
    hint: "Resume where it stopped",
  });
  return row.resumable ? [resume, again] : [again];
}

/** What a person should know, the newest last. */
function notices(): Child {
  const found = () => watched().picture.notices;
  return () =>
    found().length
      ? h(
          "ul",
          { class: "job-notices" },
          found()
            .slice(-3)
            .map((text) => h("li", {}, text)),
        )
      : null;
}

const KINDS: Readonly<Record<JobResult["kind"], string>> = {
  actuation: "table",
  measured: "measured on held-out presses",
  rig: "learned from the rig",
  button: "button",
  recording: "recording",
};

function results(row: JobRow): Child {
  if (!row.results.length) return null;
  const button_ = row.results.find((result) => result.kind === "button");
  const kept = row.results.map((result) =>
    h("li", {}, h("span", { class: "muted" }, KINDS[result.kind]), ` ${result.name}`),
  );
  const open = button_
    ? button({ label: "Open in the editor", kind: "main", act: () => go("edit", `own:${button_.name}`) })
    : null;
  return h("div", { class: "job-results" }, h("h3", {}, "Saved in the project"), h("ul", {}, kept), open);
}
