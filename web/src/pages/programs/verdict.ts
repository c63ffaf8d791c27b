/** What the check says of a program, in one sentence, and what comes after it. */

import type { Step, Verdict } from "../../app/verdict";
import type { ProgramFinding } from "../../net/messages";
import type { ProgramBook } from "./book";

/** Name where something was found. */
export function placeOf({ state, place }: ProgramFinding): string {
  return state ? `${state}, ${place}` : place;
}

/** Say whether a device would take the program; `show` leads to a finding. */
export function verdictOf(book: ProgramBook, show: (finding: ProgramFinding) => void, next: Step): Verdict {
  const findings = book.findings();
  const refused = findings.find(({ severity }) => severity === "refused");
  if (refused) {
    const more = findings.length > 1 ? `; ${findings.length - 1} more` : "";
    const sentence = `Not ready: ${refused.reason} (${placeOf(refused)}${more}).`;
    return { sentence, kind: "warning", next: { label: "Show where", act: () => show(refused) } };
  }
  if (!book.check()) return { sentence: "Checking the program…" };
  const { length } = book.document().states;
  const states = length === 1 ? "1 state" : `${length} states`;
  const [warning] = findings;
  return warning
    ? { sentence: `Ready: ${states}, but ${warning.reason} (${placeOf(warning)}).`, kind: "warning", next }
    : { sentence: `Ready: ${states}, no findings.`, kind: "good", next };
}
