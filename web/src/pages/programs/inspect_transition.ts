/** Fields of a transition. */

import { transitionInWords } from "../../programs/condition";
import { type State, type Transition, transitionsOf } from "../../programs/document";
import { changeTransition, moveTransitionTo, reorderTransition } from "../../programs/edits";
import { button, choice, h } from "../../ui";
import type { ProgramBook } from "./book";
import { conditionField, nameChoice } from "./fields";

/** When a transition is taken, where it leads, what it plays. */
export function transitionFields(
  book: ProgramBook,
  from: string,
  index: number,
  remove: () => void,
): readonly HTMLElement[] {
  const state = (): State | undefined => book.document().states.find((state) => state.name === from);
  const transition = (): Transition | undefined => {
    const held = state();
    return held && transitionsOf(held)[index];
  };
  const change = (label: string, fields: Partial<Transition>, nudge?: string): void =>
    book.edit(label, (held) => changeTransition(held, from, index, fields), nudge);
  const signals = (book.document().signals ?? []).map((signal) => signal.name);
  return [
    h("p", { class: "sentence" }, () => sentence(from, transition(), state())),
    ends(book, from, index, transition, change),
    conditionField(
      "When",
      () => transition()?.when,
      (condition) => condition && change("condition", { when: condition }, `when ${from} ${index}`),
    ),
    conditionField(
      "Only while",
      () => transition()?.only_if,
      (condition) => change("guard", { only_if: condition }, `guard ${from} ${index}`),
      true,
    ),
    nameChoice(
      "Plays",
      signals,
      () => transition()?.signal,
      (signal) => change("signal", { signal }),
      "what the state plays",
    ),
    actions(book, from, index, state, remove),
  ];
}

function sentence(from: string, transition: Transition | undefined, state: State | undefined): string {
  if (!transition) return "";
  return `From “${from}” to “${transition.to}” ${transitionInWords(transition.when, transition.only_if, state?.velocity)}.`;
}

function ends(
  book: ProgramBook,
  from: string,
  index: number,
  transition: () => Transition | undefined,
  change: (label: string, fields: Partial<Transition>) => void,
): HTMLElement {
  const names = book.document().states.map((state) => [state.name, state.name] as const);
  const begin = (other: string): void => {
    const [, fresh] = moveTransitionTo(book.document.peek(), from, index, other);
    book.edit("begin elsewhere", (held) => moveTransitionTo(held, from, index, other)[0]);
    book.choose({ kind: "transition", state: other, index: fresh });
  };
  return h(
    "div",
    { class: "grid" },
    choice({ label: "From", options: names, value: () => from, set: begin }),
    choice({
      label: "To",
      options: names,
      value: () => transition()?.to ?? "",
      set: (to) => change("end elsewhere", { to }),
    }),
  );
}

function actions(
  book: ProgramBook,
  from: string,
  index: number,
  state: () => State | undefined,
  remove: () => void,
): HTMLElement {
  const move = (by: -1 | 1): void => {
    book.edit("order of transitions", (held) => reorderTransition(held, from, index, by));
    book.choose({ kind: "transition", state: from, index: index + by });
  };
  const count = (): number => transitionsOf(state() ?? { name: "", press: "", release: "" }).length;
  return h(
    "div",
    { class: "row" },
    button({ label: "Try earlier", disabled: index === 0, act: () => move(-1) }),
    button({ label: "Try later", disabled: () => index >= count() - 1, act: () => move(1) }),
    button({ label: "Remove transition", kind: "danger", act: remove }),
  );
}
