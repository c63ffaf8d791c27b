/** What there is to begin with: the person's own programs, the shipped ones, recipes, a file. */

import { address, go } from "../../app/route";
import { call } from "../../net";
import type { ProgramRow } from "../../net/messages";
import { button, empty, h, panel, tell, toast } from "../../ui";
import { recipeForm } from "./recipe";
import { refreshRows, rows } from "./server";

/** Files above this size are not even sent; the server's own limit is the same. */
export const LARGEST_bytes = 2_000_000;

/** The first view of the page. */
export function gallery(host: HTMLElement): void {
  refreshRows();
  const own = (): readonly ProgramRow[] =>
    (rows()?.programs ?? []).filter((row) => row.id.startsWith("own:"));
  const shipped = (): readonly ProgramRow[] =>
    (rows()?.programs ?? []).filter((row) => row.id.startsWith("shipped:"));
  host.append(
    h("div", { class: "row spread" }, h("h1", {}, "Programs"), h("div", { class: "row" }, importer())),
    h(
      "p",
      { class: "muted" },
      "A program is a button with several states: each has its forces and key level, and transitions lead from one to another.",
    ),
    panel(
      "Your programs",
      h("div", { class: "cards" }, () => (own().length ? own().map(card) : nothing())),
    ),
    panel(
      "Shipped programs",
      h("div", { class: "cards" }, () => shipped().map(card)),
    ),
    panel(
      "Create from parameters",
      h("div", { class: "cards recipes" }, () => (rows()?.recipes ?? []).map((recipe) => recipeForm(recipe))),
    ),
  );
}

function nothing(): HTMLElement {
  return empty("None yet", "Copy a shipped program below, create one from parameters, or import a file.");
}

function card(row: ProgramRow): HTMLElement {
  const own = row.id.startsWith("own:");
  const size = row.problem ? "" : `${row.states} states, ${row.transitions} transitions`;
  return h(
    "article",
    { class: "card", "aria-label": row.name },
    h(
      "h3",
      {},
      row.problem
        ? row.name
        : h("a", { href: address("programs", row.id) }, own ? row.name : row.id.slice("shipped:".length)),
    ),
    h("p", {}, row.problem ? `It cannot be read: ${row.problem}` : row.summary),
    h("p", { class: "muted" }, size),
    row.problem ? null : h("div", { class: "row" }, openIt(row), copyIt(row), own ? deleteIt(row) : null),
  );
}

function openIt(row: ProgramRow): HTMLElement {
  return button({
    label: "Open",
    hint: `Open ${row.name}`,
    kind: row.id.startsWith("own:") ? "main" : "plain",
    act: () => go("programs", row.id),
  });
}

function copyIt(row: ProgramRow): HTMLElement {
  const act = (): void =>
    void call("program.copy", { program: row.id }).then((copied) => go("programs", copied.program), tell);
  const own = row.id.startsWith("own:");
  return button({ label: own ? "Copy" : "Copy and edit", kind: own ? "plain" : "main", act });
}

function deleteIt(row: ProgramRow): HTMLElement {
  const act = async (): Promise<void> => {
    const { revision } = await call("program.open", { program: row.id });
    const thrown = await call("program.delete", { program: row.id, revision });
    refreshRows();
    offerBack(row.name, thrown.thrown);
  };
  return button({ label: "Delete", kind: "danger", act: () => void act().catch(tell) });
}

/** Say that a program is gone, with an undo while the notice is shown. */
export function offerBack(name: string, thrown: string): void {
  toast(`“${name}” is in the trash.`, "done", [
    "Undo",
    () => void call("program.restore", { thrown }).then(refreshRows, tell),
  ]);
}

function importer(): HTMLElement {
  const input: HTMLInputElement = h("input", {
    type: "file",
    accept: ".json,.fdvv-program.json",
    hidden: true,
    "aria-label": "A program's file",
    on: { change: () => void bring(input).catch(tell) },
  });
  return h(
    "span",
    {},
    input,
    button({ label: "Import a file…", hint: "A *.fdvv-program.json", act: () => input.click() }),
  );
}

async function bring(input: HTMLInputElement): Promise<void> {
  const file = input.files?.[0];
  input.value = "";
  if (!file) return;
  if (file.size > LARGEST_bytes)
    throw new Error(
      `${file.name}: larger than ${LARGEST_bytes / 1e6} MB; use fewer points or fewer velocities`,
    );
  const kept = await call("program.keep", { text: await file.text() });
  go("programs", kept.program);
}
