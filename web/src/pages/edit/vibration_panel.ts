/** The vibration that serves the active curve: its wave, its modes as numbers, and how it sounds. */

import { nearestVibration } from "../../math";
import {
  addMode,
  addVibration,
  copyVibration,
  type Edit,
  type Mode,
  moveVibration,
  newVibration,
  removeMode,
  removeVibration,
  setDuration,
  setMode,
  setOnset,
  type Vibration,
} from "../../model";
import {
  addShortcuts,
  button,
  computed,
  empty,
  h,
  numberField,
  panel,
  type Signal,
  signal,
  untracked,
} from "../../ui";
import { type EditorController, refOf } from "./editor_controller";
import { wordsOf } from "./look";
import { filled } from "./rows";
import { playVibration } from "./sound";
import { wavePlot } from "./wave_plot";

/** The panels; the active curve decides which vibration is shown. */
export function vibrationPanels(editor: EditorController): HTMLElement[] {
  const serving = computed(() =>
    nearestVibration(editor.model().vibrations, editor.active().stroke, editor.active().velocity_mm_s ?? 0),
  );
  const there = computed(() => serving() !== null);
  const mode = signal(0);
  addShortcuts({ keys: "V", does: "Play the vibration", act: () => play(serving()) });
  const content = () => (there() ? untracked(() => parts(editor, serving, mode)) : none(editor));
  return [h("div", { class: "stack" }, content)];
}

function play(vibration: Vibration | null): void {
  if (vibration) void playVibration(vibration);
}

function none(editor: EditorController): HTMLElement {
  const add = () => void editor.apply(addVibration(newVibration(editor.active.peek(), startOf(editor))));
  return empty(
    "No vibration",
    `The ${editor.active().stroke} has none yet. A click starts at the snap.`,
    button({ label: "Add a vibration", kind: "main", act: add }),
  );
}

/** Where a new vibration starts: at the valley of the snap, else at the actuation, else half-way. */
function startOf(editor: EditorController): number {
  const model = editor.model.peek();
  return editor.landmarks()?.valley_mm ?? model.actuation_mm ?? 0.5 * model.travel_mm;
}

type Serving = () => Vibration | null;

function parts(editor: EditorController, serving: Serving, mode: Signal<number>): HTMLElement[] {
  const said = () => {
    const v = serving();
    if (!v) return "";
    return v.velocity_mm_s === null ? `of every ${v.stroke}` : `of ${wordsOf(v)}`;
  };
  return [
    panel("Wave", h("p", { class: "muted" }, said), wavePlot(editor, serving, mode), owner(editor, serving)),
    panel("Modes", modesTable(editor, serving, mode)),
  ];
}

function owner(editor: EditorController, serving: Serving): HTMLElement {
  const edit = (make: (v: Vibration) => Edit | null) => () => {
    const made = serving();
    const change = made && make(made);
    if (change) editor.apply(change);
  };
  const own = (v: Vibration) =>
    v.velocity_mm_s === null
      ? moveVibration(v, editor.active.peek())
      : copyVibration(v, editor.active.peek());
  const isOwn = () => serving()?.velocity_mm_s === editor.active().velocity_mm_s;
  const general = (v: Vibration) => moveVibration(v, { stroke: v.stroke, velocity_mm_s: null });
  const alone = () =>
    editor.model().vibrations.filter((v) => v.stroke === editor.active().stroke).length === 1;
  const field = (
    label: string,
    unit: string,
    of: (v: Vibration) => number,
    set: (v: Vibration, value: number) => Edit,
    more: object,
  ) =>
    numberField({
      label,
      unit,
      value: () => (serving() ? of(serving()!) : null),
      set: (value) => edit((v) => set(v, value))(),
      ...more,
    });
  return h(
    "div",
    { class: "stack" },
    h(
      "div",
      { class: "edit-pairs" },
      field(
        "Onset",
        "mm",
        (v) => v.onset_mm,
        (v, x) => setOnset(v, x),
        { digits: 4, step: 0.05, least: 0 },
      ),
      field(
        "Length",
        "ms",
        (v) => 1000 * v.duration_s,
        (v, ms) => setDuration(v, ms / 1000),
        { digits: 3, step: 1, least: 0.1, most: 2000 },
      ),
    ),
    h(
      "div",
      { class: "row" },
      button({
        label: "Play",
        kind: "main",
        act: () => play(serving()),
        hint: "As sound, at a comfortable loudness (V)",
      }),
      button({
        label: "Only this curve",
        act: edit(own),
        disabled: isOwn,
        hint: "Use a separate vibration for the active curve",
      }),
      button({
        label: "For every speed",
        act: edit(general),
        disabled: () => !alone() || serving()?.velocity_mm_s === null,
      }),
      button({ label: "Remove", kind: "danger", act: edit((v) => removeVibration(refOf(v))) }),
    ),
  );
}

const NUMBERS = [
  { name: "frequency_Hz", label: "frequency", unit: "Hz", digits: 2, step: 5, least: 0.1, most: 20000 },
  {
    name: "amplitude_m_s2",
    label: "amplitude",
    unit: "m/s²",
    digits: 4,
    step: 0.5,
    least: undefined,
    most: 1e6,
  },
  { name: "decay_1_s", label: "decay", unit: "1/s", digits: 3, step: 5, least: 0, most: 1e6 },
  { name: "phase_rad", label: "phase", unit: "rad", digits: 4, step: 0.1, least: undefined, most: undefined },
] as const satisfies readonly { name: keyof Mode; [more: string]: unknown }[];

function modesTable(editor: EditorController, serving: Serving, chosen: Signal<number>): HTMLElement {
  const count = computed(() => serving()?.modes.length ?? 0);
  const rows = () =>
    Array.from({ length: count() }, (_, index) => untracked(() => modeRow(editor, serving, chosen, index)));
  const head = [
    h("th", { scope: "col" }, "mode"),
    ...NUMBERS.map(({ label, unit }) => h("th", { scope: "col" }, `${label}, ${unit}`)),
    h("th", {}),
  ];
  const add = () => {
    const v = serving();
    if (
      v &&
      editor.apply(
        addMode(refOf(v), {
          ...v.modes.at(-1)!,
          frequency_Hz: 2 * v.modes.at(-1)!.frequency_Hz,
          amplitude_m_s2: 0.5 * v.modes.at(-1)!.amplitude_m_s2,
        }),
      )
    )
      chosen.set(v.modes.length);
  };
  return h(
    "div",
    { class: "stack" },
    h(
      "div",
      { class: "edit-scroll" },
      h("table", { class: "edit-modes" }, h("thead", {}, h("tr", {}, head)), filled(h("tbody", {}), rows)),
    ),
    h("div", { class: "row" }, button({ label: "Add mode", act: add })),
  );
}

function modeRow(
  editor: EditorController,
  serving: Serving,
  chosen: Signal<number>,
  index: number,
): HTMLElement {
  const value = (name: keyof Mode) => serving()?.modes[index]?.[name] ?? null;
  const cell = ({ name, label, ...bounds }: (typeof NUMBERS)[number]) => {
    const { unit, digits, step, least, most } = bounds;
    const within = { ...(least === undefined ? {} : { least }), ...(most === undefined ? {} : { most }) };
    return h(
      "td",
      {},
      numberField({
        label: `${label} of mode ${index + 1}`,
        unit,
        digits,
        step,
        ...within,
        bare: true,
        value: () => value(name),
        set: (to) => editor.apply(setMode(refOf(serving()!), index, { [name]: to }), `${name}${index}`),
      }),
    );
  };
  const remove = () => {
    if (editor.apply(removeMode(refOf(serving()!), index)))
      chosen.update((at) => Math.max(0, Math.min(at, (serving()?.modes.length ?? 1) - 1)));
  };
  return h(
    "tr",
    {},
    h(
      "td",
      {},
      button({
        label: String(index + 1),
        act: () => chosen.set(index),
        pressed: () => chosen() === index,
        hint: "Show its handles on the wave",
      }),
    ),
    NUMBERS.map(cell),
    h(
      "td",
      {},
      button({
        label: `Remove mode ${index + 1}`,
        glyph: "×",
        kind: "quiet",
        act: remove,
        disabled: () => (serving()?.modes.length ?? 0) < 2,
      }),
    ),
  );
}
