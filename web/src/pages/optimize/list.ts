/** All runs, and the form that begins one. */

import { address } from "../../app/route";
import { call } from "../../net";
import type { OptimizeRow } from "../../net/messages";
import { empty, h, onCleanup, signal, tell } from "../../ui";
import { newRun } from "./create";
import { scoreText } from "./store";

export function runList(host: HTMLElement): void {
  const rows = signal<readonly OptimizeRow[] | null>(null);
  let gone = false;
  onCleanup(() => (gone = true));
  call("optimize.list", {}).then((found) => !gone && rows.set(found.rows), tell);
  host.append(
    h("h1", { class: "visually-hidden" }, "Optimise"),
    h(
      "div",
      { class: "opt-start" },
      newRun(),
      h("section", { class: "panel", "aria-label": "Runs" }, h("h2", {}, "Runs"), () => listed(rows())),
    ),
  );
}

function listed(rows: readonly OptimizeRow[] | null): HTMLElement {
  if (!rows) return h("p", { class: "muted" }, "…");
  if (!rows.length)
    return empty(
      "No runs yet",
      "Choose what to optimise and begin: runs stay here, and you can resume them.",
    );
  return h("ul", { class: "opt-runs" }, rows.map(item));
}

function item(row: OptimizeRow): HTMLElement {
  if (row.problem)
    return h("li", { class: "opt-run" }, h("strong", {}, row.title), h("p", { class: "wrong" }, row.problem));
  const what = row.preference ? "comparisons" : "trials";
  return h(
    "li",
    {},
    h(
      "a",
      { class: "opt-run", href: address("optimize", String(row.run)) },
      h(
        "span",
        { class: "row spread" },
        h("strong", {}, row.title),
        row.simulated ? h("span", { class: "tag simulated" }, "simulated") : null,
      ),
      h(
        "span",
        { class: "muted" },
        `${row.engine}, ${row.preference ? "preference" : row.level}, ${row.spent} of ${row.budget} ${what}`,
      ),
      row.best ? h("span", {}, `best score ${scoreText(row.best, "ms")}`) : null,
    ),
  );
}
