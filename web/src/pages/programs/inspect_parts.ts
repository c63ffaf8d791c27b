/** Fields of the program itself, of its surfaces, signals and vibrations. */

import {
  BOUNDS,
  type During,
  type Mode,
  type ProgramDocument,
  type Signal,
  type VibrationEvent,
} from "../../programs/document";
import { changeProgram } from "../../programs/edits";
import * as parts from "../../programs/edits_parts";
import type { Choice } from "../../programs/path";
import { button, choice, h, numberField, toggle } from "../../ui";
import type { ProgramBook } from "./book";
import { nameField, textField } from "./fields";

const CLICK: Signal = {
  name: "click",
  duration_s: 0.012,
  modes: [{ frequency_Hz: 200, amplitude_m_s2: 6, decay_1_s: 250 }],
};

/** Name, travel, description, and everything that is in the program but in no picture. */
export function programFields(book: ProgramBook): readonly HTMLElement[] {
  const change = (label: string, fields: Partial<ProgramDocument>, nudge?: string): void =>
    book.edit(label, (held) => changeProgram(held, fields), nudge);
  const document = book.document();
  return [
    nameField(
      "Name",
      document.name,
      () => [],
      (name) => change("rename the program", { name }),
    ),
    textField({
      label: "What it does",
      value: () => book.document().description ?? "",
      set: (description) => change("description", { description }),
    }),
    numberField({
      label: "Travel",
      unit: "mm",
      least: BOUNDS.travel_mm[0],
      most: BOUNDS.travel_mm[1],
      step: 0.1,
      digits: 4,
      value: () => book.document().travel_mm,
      set: (travel_mm) => change("travel", { travel_mm }, "travel"),
    }),
    list(
      book,
      "Surfaces",
      document.surfaces.map((held) => [held.name, { kind: "surface", surface: held.name }]),
      null,
    ),
    list(
      book,
      "Signals",
      (document.signals ?? []).map((held) => [held.name, { kind: "signal", signal: held.name }]),
      () => addClick(book),
    ),
    list(
      book,
      "Vibrations at displacements",
      (document.vibrations ?? []).map((held, index) => [eventText(held), { kind: "vibration", index }]),
      () => tie(book),
    ),
  ];
}

function eventText(event: VibrationEvent): string {
  return `${event.signal} at ${event.at_mm} mm, ${event.stroke ?? "press"}`;
}

type Row = readonly [string, Choice];

function list(book: ProgramBook, title: string, rows: readonly Row[], add: (() => void) | null): HTMLElement {
  const items = rows.map(([words, choice_]) =>
    h(
      "li",
      {},
      h(
        "button",
        { type: "button", class: "button quiet way", on: { click: () => book.choose(choice_) } },
        words,
      ),
    ),
  );
  return h(
    "div",
    {},
    h(
      "div",
      { class: "row spread" },
      h("h3", {}, title),
      add ? button({ label: `Add to ${title.toLowerCase()}`, glyph: "+", kind: "quiet", act: add }) : null,
    ),
    items.length > 0 ? h("ul", { class: "ways" }, items) : h("p", { class: "muted" }, "none"),
  );
}

function addClick(book: ProgramBook): void {
  const [, name] = parts.addSignal(book.document.peek(), CLICK);
  book.edit(`add ${name}`, (held) => parts.addSignal(held, CLICK)[0]);
  book.choose({ kind: "signal", signal: name });
}

/** Tie the first signal to the middle of the travel; without a signal make one. */
function tie(book: ProgramBook): void {
  const at_mm = Math.round(book.document.peek().travel_mm * 50) / 100;
  book.edit("add a vibration", (held) => {
    const [known, name] = held.signals?.[0] ? [held, held.signals[0].name] : parts.addSignal(held, CLICK);
    return parts.addVibration(known, { signal: name, at_mm });
  });
  book.choose({ kind: "vibration", index: (book.document.peek().vibrations?.length ?? 1) - 1 });
}

/** Name of a surface and who feels it; its forces are drawn. */
export function surfaceFields(book: ProgramBook, name: string): readonly HTMLElement[] {
  const document = book.document();
  const surface = document.surfaces.find((surface) => surface.name === name);
  const uses = parts.usesOfSurface(document, name);
  const rename = (to: string): void => {
    book.edit(`rename ${name}`, (held) => parts.renameSurface(held, name, to));
    book.choose({ kind: "surface", surface: to });
  };
  return [
    nameField("Name", name, () => book.document().surfaces.map((surface) => surface.name), rename),
    h(
      "p",
      { class: "muted" },
      `${surface?.displacement_mm.length ?? 0} points at ${surface?.velocity_mm_s.length ?? 0} velocities`,
    ),
    h(
      "p",
      {},
      uses.length
        ? `Used in ${uses.map((use) => `${use.state} (${use.stroke})`).join(", ")}.`
        : "No state uses it.",
    ),
    h(
      "div",
      { class: "row" },
      ...uses
        .slice(0, 1)
        .map((use) =>
          button({ label: "See its forces", act: () => book.choose({ kind: "state", state: use.state }) }),
        ),
      button({
        label: "Remove surface",
        kind: "danger",
        disabled: uses.length > 0,
        act: () => book.edit(`remove ${name}`, (held) => parts.removeSurface(held, name)),
      }),
      back(book),
    ),
  ];
}

function back(book: ProgramBook): HTMLElement {
  return button({ label: "Back to the program", kind: "quiet", act: () => book.choose({ kind: "program" }) });
}

/** A signal: its length and its damped sinusoids. */
export function signalFields(book: ProgramBook, name: string): readonly HTMLElement[] {
  const signal = (): Signal =>
    (book.document().signals ?? []).find((signal) => signal.name === name) ?? CLICK;
  const change = (label: string, fields: Partial<Signal>, nudge?: string): void =>
    book.edit(`${label} of ${name}`, (held) => parts.changeSignal(held, name, fields), nudge);
  const rename = (to: string): void => {
    book.edit(`rename ${name}`, (held) => parts.renameSignal(held, name, to));
    book.choose({ kind: "signal", signal: to });
  };
  const modes = signal().modes.map((_, i) => modeFields(i, signal, change));
  return [
    nameField("Name", name, () => (book.document().signals ?? []).map((signal) => signal.name), rename),
    numberField({
      label: "Length",
      unit: "ms",
      least: 1,
      most: 4000,
      value: () => signal().duration_s * 1000,
      set: (ms) => change("length", { duration_s: ms / 1000 }, "length"),
    }),
    ...modes,
    h(
      "div",
      { class: "row" },
      button({
        label: "Add a mode",
        act: () => change("modes", { modes: [...signal().modes, CLICK.modes[0]!] }),
      }),
      button({
        label: "Remove signal",
        kind: "danger",
        act: () => book.edit(`remove ${name}`, (held) => parts.removeSignal(held, name)),
      }),
      back(book),
    ),
  ];
}

const MODE: readonly (readonly [keyof Mode, string, string, number, number, number])[] = [
  ["frequency_Hz", "Frequency", "Hz", 1, 2000, 10],
  ["amplitude_m_s2", "Amplitude", "m/s²", -500, 500, 1],
  ["decay_1_s", "Decay", "1/s", 0, 10_000, 10],
  ["phase_rad", "Phase", "rad", -7, 7, 0.1],
];

function modeFields(
  index: number,
  signal: () => Signal,
  change: (label: string, fields: Partial<Signal>, nudge?: string) => void,
): HTMLElement {
  const set = (fields: Partial<Mode>, nudge: string): void =>
    change(
      "mode",
      { modes: signal().modes.map((mode, i) => (i === index ? { ...mode, ...fields } : mode)) },
      nudge,
    );
  const remove = (): void => change("modes", { modes: signal().modes.filter((_, i) => i !== index) });
  return h(
    "fieldset",
    { class: "grid" },
    h("legend", {}, `Mode ${index + 1}`),
    MODE.map(([field, label, unit, least, most, step]) =>
      numberField({
        label,
        unit,
        least,
        most,
        step,
        value: () => signal().modes[index]?.[field] ?? 0,
        set: (value) => set({ [field]: value }, `${index} ${field}`),
      }),
    ),
    button({ label: "Remove mode", kind: "quiet", disabled: () => signal().modes.length < 2, act: remove }),
  );
}

const STROKES: readonly (readonly [During, string])[] = [
  ["press", "press"],
  ["release", "release"],
  ["either", "either stroke"],
];

/** Where a signal is felt, at which velocities, in which states. */
export function vibrationFields(book: ProgramBook, index: number): readonly HTMLElement[] {
  const event = (): VibrationEvent => book.document().vibrations?.[index] ?? { signal: "", at_mm: 0 };
  const change = (fields: Partial<VibrationEvent>, nudge?: string): void =>
    book.edit("vibration", (held) => parts.changeVibration(held, index, fields), nudge);
  const signals = (book.document().signals ?? []).map((signal) => [signal.name, signal.name] as const);
  const number = (
    field: "at_mm" | "slowest_mm_s" | "fastest_mm_s",
    label: string,
    unit: string,
  ): HTMLElement => {
    const [least, most] = BOUNDS[field === "at_mm" ? "at_mm" : "velocity_mm_s"];
    return numberField({
      label,
      unit,
      least,
      most,
      step: unit === "mm" ? 0.05 : 10,
      value: () => event()[field] ?? null,
      set: (value) => change({ [field]: value }, field),
    });
  };
  return [
    h(
      "div",
      { class: "grid" },
      choice({
        label: "Signal",
        options: signals,
        value: () => event().signal,
        set: (signal) => change({ signal }),
      }),
      number("at_mm", "at", "mm"),
      choice({
        label: "in the",
        options: STROKES,
        value: () => event().stroke ?? "press",
        set: (stroke) => change({ stroke }),
      }),
      number("slowest_mm_s", "from", "mm/s"),
      number("fastest_mm_s", "below", "mm/s"),
      button({
        label: "Any velocity",
        kind: "quiet",
        act: () => change({ slowest_mm_s: null, fastest_mm_s: null }),
      }),
    ),
    inStates(book, event, change),
    h(
      "div",
      { class: "row" },
      button({
        label: "Remove vibration",
        kind: "danger",
        act: () => book.edit("remove a vibration", (held) => parts.removeVibration(held, index)),
      }),
      back(book),
    ),
  ];
}

function inStates(
  book: ProgramBook,
  event: () => VibrationEvent,
  change: (fields: Partial<VibrationEvent>) => void,
): HTMLElement {
  const names = book.document().states.map((state) => state.name);
  const held = (name: string): boolean => !event().states?.length || event().states!.includes(name);
  const set = (name: string, on: boolean): void => {
    const now = names.filter((other) => (other === name ? on : held(other)));
    // none named means all
    change({ states: now.length === names.length || now.length === 0 ? [] : now });
  };
  return h(
    "fieldset",
    { class: "row" },
    h("legend", {}, "In the states"),
    names.map((name) => toggle({ label: name, value: () => held(name), set: (on) => set(name, on) })),
  );
}
