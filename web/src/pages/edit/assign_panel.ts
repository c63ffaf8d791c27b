/** Take a curve, or a part of one, from this button or another, and give it to a stroke and a speed. */

import { controlPoints_mm, end_mm, STROKES, type Stroke, start_mm } from "../../math";
import {
  assignCurve,
  type CurveRef,
  copyCurve,
  copySegment,
  type Edit,
  type FDVVModel,
  mergeModels,
} from "../../model";
import {
  button,
  choice,
  computed,
  effect,
  h,
  numberField,
  panel,
  type Signal,
  signal,
  toggle,
} from "../../ui";
import type { EditorController, Span } from "./editor_controller";
import { keyOf, wordsOf } from "./look";
import { pickButton } from "./pick";

interface Choices {
  /** null takes from this button. */
  readonly other: Signal<FDVVModel | null>;
  readonly from: Signal<string>;
  readonly stroke: Signal<Stroke>;
  readonly velocity_mm_s: Signal<number | null>;
  readonly blend_mm: Signal<number>;
}

/** The panels. */
export function assignPanels(editor: EditorController): HTMLElement[] {
  const active = editor.active.peek();
  const choices: Choices = {
    other: signal<FDVVModel | null>(null),
    from: signal(keyOf(active)),
    stroke: signal<Stroke>(active.stroke === "press" ? "release" : "press"),
    velocity_mm_s: signal(active.velocity_mm_s),
    blend_mm: signal(0.1),
  };
  return [source(editor, choices), target(editor, choices)];
}

function source(editor: EditorController, choices: Choices): HTMLElement {
  const model = computed(() => choices.other() ?? editor.settled());
  const curves = h("span", {});
  effect(() => {
    const options = model().curves.map((curve) => [keyOf(curve), wordsOf(curve)] as const);
    if (!options.some(([key]) => key === choices.from.peek())) choices.from.set(options[0]![0]);
    curves.replaceChildren(
      choice({ label: "Curve", options, value: () => choices.from(), set: (key) => choices.from.set(key) }),
    );
  });
  const back = button({
    label: "This button",
    act: () => choices.other.set(null),
    pressed: () => choices.other() === null,
  });
  return panel(
    "From",
    h("div", { class: "row" }, back, () => (choices.other() ? h("strong", {}, choices.other()!.name) : null)),
    pickButton("Another button", (found) => choices.other.set(found)),
    curves,
    () => (choices.other() ? merging(editor, choices.other()!) : null),
  );
}

/** All curves and vibrations of the other button at once; where both have one, the person says whose. */
function merging(editor: EditorController, other: FDVVModel): HTMLElement {
  const { travel_mm, actuation_mm, reset_mm, interpolation } = editor.settled.peek();
  const points = {
    ...(actuation_mm === null ? {} : { actuation_mm }),
    ...(reset_mm === null ? {} : { reset_mm }),
  };
  const merge = (conflict: "first" | "last") => () =>
    void editor.apply(mergeModels([other], { conflict, travel_mm, interpolation, ...points }));
  return h(
    "div",
    { class: "stack" },
    h("span", { class: "muted" }, "Or all of its curves and vibrations; if both have one:"),
    h(
      "div",
      { class: "row" },
      button({ label: "Merge, keep mine", act: merge("first") }),
      button({ label: "Merge, take theirs", act: merge("last") }),
    ),
  );
}

function target(editor: EditorController, choices: Choices): HTMLElement {
  const strokes = STROKES.map((stroke) => [stroke, stroke] as const);
  const part = () => editor.span();
  const act = () => {
    const to = { stroke: choices.stroke.peek(), velocity_mm_s: choices.velocity_mm_s.peek() };
    if (editor.apply(editOf(editor, choices, to))) editor.activate(to);
  };
  return panel(
    "To",
    h(
      "div",
      { class: "row" },
      choice({
        label: "Stroke",
        options: strokes,
        value: () => choices.stroke(),
        set: (to) => choices.stroke.set(to),
      }),
      numberField({
        label: "Speed",
        unit: "mm/s",
        value: () => choices.velocity_mm_s(),
        set: (v) => choices.velocity_mm_s.set(v),
        least: 0.01,
        most: 2000,
        digits: 3,
        step: 10,
      }),
    ),
    toggle({
      label: "Only a part of the travel",
      value: () => part() !== null,
      set: (on) => editor.span.set(on ? spanOfSelection(editor) : null),
    }),
    () => (part() ? bounds(editor, choices) : null),
    h(
      "div",
      { class: "row" },
      h("button", { type: "button", class: "button main", on: { click: act } }, () =>
        part() ? "Assign the part" : "Assign the curve",
      ),
    ),
  );
}

function bounds(editor: EditorController, choices: Choices): HTMLElement {
  const end = (label: string, which: "from_mm" | "to_mm") =>
    numberField({
      label,
      unit: "mm",
      value: () => editor.span()?.[which] ?? null,
      set: (x) => editor.span.update((span) => span && { ...span, [which]: x }),
      digits: 3,
      step: 0.05,
    });
  return h(
    "div",
    { class: "stack" },
    h("div", { class: "edit-pairs" }, end("From", "from_mm"), end("To", "to_mm")),
    h(
      "div",
      { class: "row" },
      button({ label: "From the selected points", act: () => editor.span.set(spanOfSelection(editor)) }),
      numberField({
        label: "Blend over",
        unit: "mm",
        value: () => choices.blend_mm(),
        set: (x) => choices.blend_mm.set(x),
        least: 0.01,
        most: 2,
        digits: 3,
        step: 0.05,
      }),
    ),
  );
}

function editOf(editor: EditorController, choices: Choices, to: CurveRef): Edit {
  const other = choices.other.peek();
  const model = other ?? editor.settled.peek();
  const from = model.curves.find((curve) => keyOf(curve) === choices.from.peek()) ?? model.curves[0]!;
  const span = editor.span.peek();
  const held = (x: number) => Math.min(end_mm(from), Math.max(start_mm(from), x));
  const segment = span && {
    segment_mm: [held(span.from_mm), held(span.to_mm)] as const,
    blend_mm: choices.blend_mm.peek(),
  };
  if (other) return assignCurve(from, to, segment ?? undefined);
  return segment ? copySegment(from, to, segment) : copyCurve(from, to);
}

/** From the first to the last selected point; the middle third of the curve if fewer than two are selected. */
function spanOfSelection(editor: EditorController): Span {
  const positions = controlPoints_mm(editor.curve());
  const selected = editor.selection.peek();
  const [first, last] =
    selected.length > 1
      ? [selected[0]!, selected.at(-1)!]
      : [Math.floor(positions.length / 3), Math.ceil((2 * positions.length) / 3)];
  const round = (x: number) => Number(x.toFixed(3));
  return { from_mm: round(positions[first]!), to_mm: round(positions[last]!) };
}
