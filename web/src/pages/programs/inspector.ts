/** The inspector: exact numbers of what is chosen in the graph. */

import type { Choice } from "../../programs/path";
import { computed, effect, h, panel, untracked } from "../../ui";
import type { ProgramBook } from "./book";
import { programFields, signalFields, surfaceFields, vibrationFields } from "./inspect_parts";
import { stateFields } from "./inspect_state";
import { transitionFields } from "./inspect_transition";

const TITLES: Readonly<Record<Choice["kind"], string>> = {
  program: "Program",
  state: "State",
  transition: "Transition",
  surface: "Surface",
  signal: "Signal",
  vibration: "Vibration",
};
const FOCUSABLE = "input, select, button, textarea";

/** Fields of what is chosen. They follow the document by themselves and are made anew only when its parts change. */
export function inspector(book: ProgramBook, edges: { readonly remove: () => void }): HTMLElement {
  const body = h("div", { class: "inspector-body" });
  const found = panel("Program", body);
  found.classList.add("inspector");
  const parts = computed(() => partsOf(book));
  let shown = "";
  effect(() => {
    const choice = book.choice();
    parts();
    const focused = [...body.querySelectorAll(FOCUSABLE)].indexOf(document.activeElement!);
    const same = shown === JSON.stringify(choice);
    shown = JSON.stringify(choice);
    found.querySelector("h2")!.textContent = TITLES[choice.kind];
    body.replaceChildren(...untracked(() => fieldsOf(book, choice, edges)));
    // fields that are made anew by one of them keep the keyboard
    if (same && focused >= 0) (body.querySelectorAll(FOCUSABLE)[focused] as HTMLElement | undefined)?.focus();
  });
  return found;
}

function fieldsOf(
  book: ProgramBook,
  choice: Choice,
  edges: { readonly remove: () => void },
): readonly HTMLElement[] {
  switch (choice.kind) {
    case "program":
      return programFields(book);
    case "state":
      return stateFields(book, choice.state, () => edges.remove());
    case "transition":
      return transitionFields(book, choice.state, choice.index, () => edges.remove());
    case "surface":
      return surfaceFields(book, choice.surface);
    case "signal":
      return signalFields(book, choice.signal);
    case "vibration":
      return vibrationFields(book, choice.index);
  }
}

/** Write down everything whose change makes other fields: names and kinds, no numbers. */
function partsOf(book: ProgramBook): string {
  const document = book.document();
  return JSON.stringify([
    document.start,
    document.states.map((state) => [
      state.name,
      state.repeat_signal ?? null,
      (state.bias_ms ?? 0) > 0,
      (state.transitions ?? []).map((transition) => [
        transition.to,
        Object.keys(transition.when),
        transition.only_if ? Object.keys(transition.only_if) : null,
      ]),
    ]),
    document.surfaces.map((surface) => surface.name),
    (document.signals ?? []).map((signal) => [signal.name, signal.modes.length]),
    (document.vibrations ?? []).map((event) => [event.signal, event.stroke ?? null, event.states ?? null]),
  ]);
}
