/** The numbers of the active curve: places of the travel, control points in a table, what edits must respect. */

import type { Constraints } from "../../math";
import { type ModelNumber, setNumber } from "../../model";
import { h, numberField, panel, type Signal, toggle } from "../../ui";
import type { EditorController } from "./editor_controller";
import { positionHandles } from "./handles";
import { wordsOf } from "./look";
import { pointsTable } from "./points_table";

/** Every panel about the points of the active curve. */
export function pointsPanels(editor: EditorController): HTMLElement[] {
  return [
    panel(
      "Positions",
      h(
        "div",
        { class: "edit-pairs" },
        positionField(editor, "travel_mm", "Travel"),
        positionField(editor, "actuation_mm", "Actuation"),
        positionField(editor, "reset_mm", "Reset"),
        onsetField(editor),
      ),
    ),
    panel(
      "Control points",
      h("p", { class: "muted" }, () => wordsOf(editor.active())),
      pointsTable(editor),
    ),
  ];
}

function positionField(editor: EditorController, which: ModelNumber, label: string): HTMLElement {
  return numberField({
    label,
    unit: "mm",
    value: () => editor.model()[which],
    set: (value) => void editor.apply(setNumber(which, value), which),
    step: 0.05,
    least: 0,
    digits: 4,
  });
}

function onsetField(editor: EditorController): HTMLElement {
  const onset = () => positionHandles(editor.model(), editor.active()).find(({ name }) => name === "onset");
  return numberField({
    label: "Vibration",
    unit: "mm",
    value: () => onset()?.at_mm ?? null,
    set: (value) => {
      const found = onset();
      if (found) editor.apply(found.edit(value), "onset");
    },
    step: 0.05,
    least: 0,
    digits: 4,
    disabled: () => !onset(),
  });
}

/** What every drag and number respects. */
export function limitsPanel(editor: EditorController): HTMLElement {
  return panel("Edits keep", limits(editor));
}

function limits(editor: EditorController): HTMLElement {
  const { constraints } = editor;
  return h(
    "div",
    { class: "edit-limits" },
    toggle({
      label: "Never falls",
      value: () => constraints().monotone === "rising",
      set: (on) => change(constraints, "monotone", on ? "rising" : undefined),
      hint: "The curve rises or stays level; no bump",
    }),
    toggle({
      label: "Keep the work",
      value: () => constraints().keepWork === true,
      set: (on) => change(constraints, "keepWork", on || undefined),
      hint: "The other points move so that the work stays the same",
    }),
    toggle({
      label: "Keep the ends",
      value: () => constraints().keepEnds === true,
      set: (on) => change(constraints, "keepEnds", on || undefined),
      hint: "The first and last control points stay",
    }),
    numberField({
      label: "Steps of",
      unit: "cN",
      value: () => constraints().step_cN ?? 0,
      set: (step) => change(constraints, "step_cN", step || undefined),
      least: 0,
      most: 100,
      digits: 3,
      step: 0.5,
    }),
  );
}

function change<K extends keyof Constraints>(
  all: Signal<Constraints>,
  name: K,
  value: Constraints[K] | undefined,
): void {
  const { [name]: _old, ...rest } = all.peek();
  all.set(value === undefined ? rest : { ...rest, [name]: value });
}
