/** A finger on the program as it is being edited; the state it is in shows in the graph. */

import { mount, unmount } from "svelte";
import { conditionValue, kindOf } from "../../programs/condition";
import { type ProgramDocument, transitionsOf } from "../../programs/document";
import { button, computed, effect, h, onCleanup, panel, untracked } from "../../ui";
import Stage from "../press/Stage.svelte";
import { PressStage } from "../press/stage";
import type { ProgramBook } from "./book";

/** Put the program under a simulated finger; call in a scope. `live` is called with the state of the press. */
export function tryPanel(book: ProgramBook, live: (state: string | null) => void): HTMLElement {
  const host = h("div", {});
  const stage = new PressStage();
  const made = mount(Stage, { target: host, props: { stage, compact: true } });
  onCleanup(() => void unmount(made));
  followEdits(book, stage);
  effect(() => {
    const [ready, frame] = [stage.session.ready(), stage.session.frame()];
    live((frame && ready?.states[frame.state]) ?? null);
  });
  onCleanup(() => live(null));
  const found = panel(
    "Press it",
    h("p", { class: "muted", role: "status" }, () => standing(book)),
    host,
    hostEvents(book, stage),
  );
  found.classList.add("try");
  return found;
}

function standing(book: ProgramBook): string {
  const refused = book.findings().some((finding) => finding.severity === "refused");
  return refused
    ? "A device would refuse this version; you are pressing the last accepted one."
    : "You press every edit as soon as it is checked.";
}

/** What was checked and accepted goes under the finger, saved or not. */
function followEdits(book: ProgramBook, stage: PressStage): void {
  effect(() => {
    const accepted = book.check()?.accepted ?? false;
    if (!accepted || book.checking()) return;
    const what = { code: { ...untracked(book.document) } };
    stage.start({ what, mode: "intended", rig: "recommended" });
  });
}

/** A button for every host event that a transition waits for. */
function hostEvents(book: ProgramBook, stage: PressStage): HTMLElement {
  const numbers = computed(() => eventsOf(book.document()).join(" "));
  return h("div", { class: "row" }, () =>
    numbers()
      .split(" ")
      .filter(Boolean)
      .map((number) =>
        button({ label: `Send event ${number}`, act: () => stage.session.hostEvent(Number(number)) }),
      ),
  );
}

/** Return the host events that a program waits for, rising. */
export function eventsOf(document: ProgramDocument): readonly number[] {
  const conditions = document.states.flatMap((state) =>
    transitionsOf(state).flatMap((transition) => [
      transition.when,
      ...(transition.only_if ? [transition.only_if] : []),
    ]),
  );
  const numbers = conditions
    .filter((condition) => kindOf(condition).kind === "host_event")
    .map((held) => conditionValue(held) ?? 0);
  return [...new Set(numbers)].sort((a, b) => a - b);
}
