/** Fields of a transition. */

import { transitionInWords } from "../../programs/condition";
import { transitionsOf, type State, type Transition } from "../../programs/document";
import { changeTransition, moveTransitionTo, reorderTransition } from "../../programs/edits";
import { button, choice, h } from "../../ui";
import type { ProgramBook } from "./book";
import { conditionField, nameChoice } from "./fields";

/** When a transition is taken, where it leads, what it plays. */
export function transitionFields(book: ProgramBook, from: string, index: number, remove: () => void): readonly HTMLElement[] {
  const state = (): State | undefined => book.document().states.find((held) => held.name === from);
  const way = (): Transition | undefined => {
    const held = state();
    return held && transitionsOf(held)[index];
  };
  const change = (label: string, fields: Partial<Transition>, nudge?: string): void =>
    book.edit(label, (held) => changeTransition(held, from, index, fields), nudge);
  const signals = (book.document().signals ?? []).map((signal) => signal.name);
  return [
    h("p", { class: "sentence" }, () => sentence(from, way(), state())),
    ends(book, from, index, way, change),
    conditionField("When", () => way()?.when, (told) => told && change("condition", { when: told }, `when ${from} ${index}`)),
    conditionField("Only while", () => way()?.only_if, (told) => change("guard", { only_if: told }, `guard ${from} ${index}`), true),
    nameChoice("Plays on the way", signals, () => way()?.signal, (signal) => change("signal", { signal }), "what the state plays"),
    actions(book, from, index, state, remove),
  ];
}

function sentence(from: string, way: Transition | undefined, state: State | undefined): string {
  if (!way) return "";
  return `From “${from}” to “${way.to}” ${transitionInWords(way.when, way.only_if, state?.velocity)}.`;
}

function ends(
  book: ProgramBook,
  from: string,
  index: number,
  way: () => Transition | undefined,
  change: (label: string, fields: Partial<Transition>) => void,
): HTMLElement {
  const names = book.document().states.map((held) => [held.name, held.name] as const);
  const begin = (other: string): void => {
    const [, fresh] = moveTransitionTo(book.document.peek(), from, index, other);
    book.edit("begin elsewhere", (held) => moveTransitionTo(held, from, index, other)[0]);
    book.choose({ kind: "transition", state: other, index: fresh });
  };
  return h(
    "div",
    { class: "grid" },
    choice({ label: "From", options: names, value: () => from, set: begin }),
    choice({ label: "To", options: names, value: () => way()?.to ?? "", set: (to) => change("end elsewhere", { to }) }),
  );
}

function actions(book: ProgramBook, from: string, index: number, state: () => State | undefined, remove: () => void): HTMLElement {
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
