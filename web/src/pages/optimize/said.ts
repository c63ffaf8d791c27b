/** What a run says in the line below the page: how far it is, then what was found and what to do next. */

import { address } from "../../app/route";
import type { Verdict } from "../../app/verdict";
import type { OptimizeDetail } from "../../net/messages";
import { foundName, type RunStore } from "./store";

/** How long work takes that has come so far, from when it was seen first. */
export class Pace {
  private from: { readonly done: number; readonly at_ms: number } | null = null;

  /** Return the seconds left, or null while nothing is known. */
  left_s(done: number, total: number, now_ms: number): number | null {
    if (!this.from || done < this.from.done) this.from = { done, at_ms: now_ms };
    const made = done - this.from.done;
    return made > 0 ? ((now_ms - this.from.at_ms) / 1000 / made) * (total - done) : null;
  }
}

export function said(store: RunStore, detail: OptimizeDetail, pace: Pace): Verdict {
  const { retest, row, simulated } = detail;
  if (retest.sentence) return found(store, detail, retest.sentence);
  const one = detail.on_lines ? "line" : row.preference ? "comparison" : "trial";
  const others = retest.rivals.length ? ` and ${retest.rivals.length} others` : "";
  const again = `the best design against ${detail.start_name}${others}, blind: ${Math.min(retest.done + 1, retest.total)} of ${retest.total}`;
  const now = store.retesting() ? again : `${one} ${Math.min(row.spent + 1, row.budget)} of ${row.budget}`;
  if (simulated?.running) {
    const left_s = pace.left_s(simulated.done, simulated.total, performance.now());
    return {
      sentence: `A simulated person plays ${now}${left_s === null ? "" : `, about ${about(left_s)} left`}.`,
    };
  }
  if (simulated?.fault)
    return { sentence: `The simulated person stopped: ${simulated.fault}.`, kind: "warning" };
  if (store.choosing() && store.retesting())
    return {
      sentence:
        "The search is over. Take a compromise under Result, or play the recommended one again, blind.",
    };
  if (!detail.searched || store.retesting()) return { sentence: `${now[0]?.toUpperCase()}${now.slice(1)}.` };
  const few = retest.done ? "one pair is too few for an interval" : "nothing was played again";
  return { sentence: `The budget is used up; ${few}, so how good the best is stays open.` };
}

function found(store: RunStore, detail: OptimizeDetail, sentence: string): Verdict {
  const { kind } = detail.retest;
  if (kind !== "better" && kind !== "mixed") {
    const to = address("edit", detail.start_button);
    return {
      sentence,
      kind: "warning",
      ...(detail.start_button && { next: { label: "Edit your button", to } }),
    };
  }
  const saved = store.saved();
  const tone = kind === "better" ? "good" : "warning";
  if (saved) return { sentence, kind: tone, next: { label: "Edit it", to: address("edit", saved) } };
  const act = () => void store.save(null, foundName(detail));
  return { sentence, kind: tone, next: { label: "Save as my button", act } };
}

/** Write a time for people. */
function about(time_s: number): string {
  return time_s < 90 ? `${Math.max(1, Math.round(time_s))} s` : `${Math.round(time_s / 60)} min`;
}
