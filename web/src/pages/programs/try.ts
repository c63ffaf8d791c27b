/** A finger on the program as it is being edited; the state it is in shows in the graph. */

import { kindOf, valueOf } from "../../programs/condition";
import { transitionsOf, type ProgramDocument } from "../../programs/document";
import { button, computed, effect, h, onCleanup, panel, untracked } from "../../ui";
import { pressStage, type PressStage } from "../press/stage";
import type { ProgramBook } from "./book";

/** Put the program under a simulated finger; call in a scope. `live` is told the state that the press is in. */
export function tryPanel(book: ProgramBook, live: (state: string | null) => void): HTMLElement {
  const host = h("div", {});
  const stage = pressStage(host, { compact: true, extra: (held) => hostEvents(book, held) });
  followEdits(book, stage);
  effect(() => {
    const [ready, frame] = [stage.session.ready(), stage.session.frame()];
    live((frame && ready?.states[frame.state]) ?? null);
  });
  onCleanup(() => live(null));
  const found = panel("Press it", h("p", { class: "muted", role: "status" }, () => standing(book)), host);
  found.classList.add("try");
  return found;
}

function standing(book: ProgramBook): string {
  const refused = book.findings().some((finding) => finding.severity === "refused");
  return refused
    ? "A device would refuse it as it is now; under the finger is what it was before."
    : "Every edit is under the finger as soon as it is checked.";
}

/** What was checked and accepted goes under the finger, saved or not. */
function followEdits(book: ProgramBook, stage: PressStage): void {
  effect(() => {
    const accepted = book.check()?.accepted ?? false;
    if (!accepted || book.checking()) return;
    const what = { code: { ...untracked(book.document) } };
    stage.start({ what, mode: "intended", rig: "paper" });
  });
}

/** A button for every host event that a transition waits for. */
function hostEvents(book: ProgramBook, stage: PressStage): HTMLElement {
  const numbers = computed(() => eventsOf(book.document()).join(" "));
  return h("div", { class: "row" }, () =>
    numbers()
      .split(" ")
      .filter(Boolean)
      .map((number) => button({ label: `Tell event ${number}`, act: () => stage.session.hostEvent(Number(number)) })),
  );
}

/** Give the host events that a program waits for, rising. */
export function eventsOf(document: ProgramDocument): readonly number[] {
  const told = document.states.flatMap((state) =>
    transitionsOf(state).flatMap((way) => [way.when, ...(way.only_if ? [way.only_if] : [])]),
  );
  const numbers = told.filter((held) => kindOf(held).kind === "host_event").map((held) => valueOf(held) ?? 0);
  return [...new Set(numbers)].sort((a, b) => a - b);
}
