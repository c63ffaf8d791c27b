/** What the check says: each finding leads to its place; and how much of a device the program takes. */

import type { ProgramCheck, ProgramFinding, ProgramSize } from "../../net/messages";
import { type Choice, choiceAt } from "../../programs/path";
import { h, panel, shown } from "../../ui";
import type { ProgramBook } from "./book";

const SIZES: Readonly<Record<string, string>> = {
  bytes: "bytes of an image",
  velocities: "velocities of a surface",
  columns: "columns of a surface",
};

/** The list of findings; `lead` is called with the subject of a clicked finding. */
export function findingsPanel(
  book: ProgramBook,
  lead: (choice: Choice, finding: ProgramFinding) => void,
): HTMLElement {
  const found = panel(
    "Check",
    h("p", { class: () => `verdict ${verdictKind(book)}`, role: "status" }, () => verdict(book)),
    h("div", { class: "findings", role: "list", hidden: () => book.findings().length === 0 }, () =>
      book.findings().map((finding) => row(book, finding, lead)),
    ),
    h("div", { class: "sizes", role: "group", "aria-label": "Device resources used" }, () =>
      sizes(book.check()),
    ),
  );
  found.classList.add("check");
  return found;
}

function verdictKind(book: ProgramBook): string {
  if (book.findings().some((finding) => finding.severity === "refused")) return "refused";
  return book.check() ? "accepted" : "";
}

function verdict(book: ProgramBook): string {
  const check = book.check();
  const refused = book.findings().filter((finding) => finding.severity === "refused").length;
  if (refused)
    return refused === 1
      ? "A device would refuse it, for one reason:"
      : `A device would refuse it, for ${refused} reasons:`;
  if (!check) return "Checking…";
  const back = check.return_s === null ? "" : `; once released it returns within ${shown(check.return_s)} s`;
  return `Accepted${back}.`;
}

function row(
  book: ProgramBook,
  finding: ProgramFinding,
  lead: (choice: Choice, finding: ProgramFinding) => void,
): HTMLElement {
  const where = finding.state ? `${finding.state}, ${finding.place}` : finding.place;
  const follow = (): void => lead(choiceOf(book, finding), finding);
  return h(
    "div",
    { class: finding.severity, role: "listitem" },
    h(
      "button",
      { type: "button", class: "button quiet finding", on: { click: follow } },
      h("strong", {}, finding.severity === "refused" ? "✕ " : "! ", where),
      h("span", {}, finding.reason),
      h("span", { class: "remedy" }, `→ ${finding.remedy}`),
    ),
  );
}

/** A surface is shown with the state that it was found in. */
function choiceOf(book: ProgramBook, finding: ProgramFinding): Choice {
  const choice = choiceAt(book.document.peek(), finding.path);
  return choice.kind === "surface" && finding.state ? { kind: "state", state: finding.state } : choice;
}

function sizes(check: ProgramCheck | null): readonly HTMLElement[] {
  return (check?.sizes ?? []).filter((size) => size.taken !== 0).map(meter);
}

function meter(size: ProgramSize): HTMLElement {
  const what = SIZES[size.what] ?? size.what;
  const full = (size.taken ?? 0) / size.most;
  return h(
    "div",
    { class: `size${full > 1 ? " over" : ""}` },
    h("span", {}, what),
    h("meter", { min: 0, max: size.most, value: size.taken ?? 0, high: 0.9 * size.most, "aria-label": what }),
    h(
      "span",
      { class: "number" },
      size.taken === null ? `– of ${size.most}` : `${size.taken} of ${size.most}`,
    ),
  );
}
