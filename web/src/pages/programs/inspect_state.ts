/** Fields of a state. */

import { inWords } from "../../programs/condition";
import { BOUNDS, type State, transitionsOf, type VelocitySource } from "../../programs/document";
import { changeState, duplicateState, renameState, reorderTransition, setStart } from "../../programs/edits";
import { button, choice, h, numberField } from "../../ui";
import type { ProgramBook } from "./book";
import { nameChoice, nameField } from "./fields";

const VELOCITIES: readonly (readonly [VelocitySource, string])[] = [
  ["decided", "measured once per press"],
  ["continuous", "measured continuously"],
  ["announced", "announced by the host"],
];

type Whole = "key" | "repeat_ms" | "fade_ms" | "bias_ms";

/** Everything about a state but its forces, which are drawn. */
export function stateFields(book: ProgramBook, name: string, remove: () => void): readonly HTMLElement[] {
  const state = (): State | undefined => book.document().states.find((state) => state.name === name);
  const change = (label: string, fields: Partial<State>, nudge?: string): void =>
    book.edit(`${label} of ${name}`, (held) => changeState(held, name, fields), nudge);
  const whole = (field: Whole, label: string, unit: string): HTMLElement =>
    numberField({
      label,
      unit,
      digits: 0,
      least: BOUNDS[field][0],
      most: BOUNDS[field][1],
      step: unit ? 10 : 1,
      value: () => state()?.[field] ?? 0,
      set: (value) => change(label, { [field]: Math.round(value) }, `${name} ${field}`),
    });
  const signals = (book.document().signals ?? []).map((signal) => signal.name);
  return [
    naming(book, name),
    h(
      "div",
      { class: "grid" },
      whole("key", "Key", ""),
      velocity(state, change),
      whole("fade_ms", "Fade in", "ms"),
    ),
    bias(state, change, whole),
    h(
      "div",
      { class: "grid" },
      nameChoice(
        "Plays on entering",
        signals,
        () => state()?.enter_signal,
        (signal) => change("signal", { enter_signal: signal }),
      ),
      nameChoice(
        "Repeats",
        signals,
        () => state()?.repeat_signal,
        (signal) => change("repeat", { repeat_signal: signal }),
      ),
      state()?.repeat_signal ? whole("repeat_ms", "every", "ms") : null,
    ),
    outgoing(book, name),
    actions(book, name, remove),
  ];
}

function naming(book: ProgramBook, name: string): HTMLElement {
  const others = (): readonly string[] => book.document().states.map((state) => state.name);
  const field = nameField("Name", name, others, (to) => {
    book.edit(`rename ${name}`, (held) => renameState(held, name, to));
    book.choose({ kind: "state", state: to });
  });
  return h("div", { class: "row" }, field);
}

function velocity(
  state: () => State | undefined,
  change: (label: string, fields: Partial<State>) => void,
): HTMLElement {
  return choice({
    label: "Velocity",
    options: VELOCITIES,
    value: () => state()?.velocity ?? "decided",
    set: (source) => change("velocity", { velocity: source }),
  });
}

function bias(
  state: () => State | undefined,
  change: (label: string, fields: Partial<State>, nudge?: string) => void,
  whole: (field: Whole, label: string, unit: string) => HTMLElement,
): HTMLElement {
  const force = (field: "bias_cN" | "bias_end_cN", label: string): HTMLElement =>
    numberField({
      label,
      unit: "cN",
      least: -440,
      most: 440,
      step: 1,
      value: () => state()?.[field] ?? 0,
      set: (value) => change(label, { [field]: value }, field),
    });
  const ramp = (state()?.bias_ms ?? 0) > 0;
  return h(
    "div",
    { class: "grid" },
    force("bias_cN", "Added force"),
    whole("bias_ms", "changing in", "ms"),
    ramp ? force("bias_end_cN", "to") : null,
  );
}

/** The ways out in the order in which they are tried, to choose and to reorder. */
function outgoing(book: ProgramBook, name: string): HTMLElement {
  const state = book.document().states.find((state) => state.name === name);
  const transitions = state ? transitionsOf(state) : [];
  if (transitions.length === 0)
    return h(
      "p",
      { class: "muted" },
      "No transition leads out. Drag from the dot at its edge, or press T on it.",
    );
  const rows = transitions.map((_, i) => {
    const transition = () =>
      transitionsOf(book.document().states.find((state) => state.name === name) ?? state!)[i] ??
      transitions[i]!;
    return h(
      "li",
      { class: "row spread" },
      h(
        "button",
        {
          type: "button",
          class: "button quiet way",
          on: { click: () => book.choose({ kind: "transition", state: name, index: i }) },
        },
        () => `to ${transition().to} when ${inWords(transition().when, state?.velocity)}`,
      ),
      button({
        label: "Try it earlier",
        glyph: "↑",
        kind: "quiet",
        disabled: i === 0,
        act: () => book.edit("order of transitions", (held) => reorderTransition(held, name, i, -1)),
      }),
    );
  });
  return h("div", {}, h("h3", {}, "Transitions, tried in this order"), h("ol", { class: "ways" }, rows));
}

function actions(book: ProgramBook, name: string, remove: () => void): HTMLElement {
  const copy = (): void => {
    const [, fresh] = duplicateState(book.document.peek(), name);
    book.edit(`copy ${name}`, (held) => duplicateState(held, name)[0]);
    book.choose({ kind: "state", state: fresh });
  };
  return h(
    "div",
    { class: "row" },
    button({
      label: "Start here",
      disabled: () => book.document().start === name,
      act: () => book.edit(`start at ${name}`, (held) => setStart(held, name)),
    }),
    button({ label: "Duplicate", act: copy }),
    button({
      label: "Remove state",
      kind: "danger",
      disabled: () => book.document().states.length < 2,
      act: remove,
    }),
  );
}
