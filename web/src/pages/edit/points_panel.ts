/** The numbers of the active curve: places of the travel, control points in a table, what edits must respect. */

import { h, numberField, panel, type Signal, toggle } from "../../ui";
import type { Constraints } from "../../math";
import { type ModelNumber, setNumber } from "../../model";
import type { Desk } from "./desk";
import { placeHandles } from "./handles";
import { wordsOf } from "./look";
import { pointsTable } from "./points_table";

/** Every panel about the points of the active curve. */
export function pointsPanels(desk: Desk): HTMLElement[] {
  return [
    panel("Places", h("div", { class: "edit-pairs" }, placeField(desk, "travel_mm", "Travel"), placeField(desk, "actuation_mm", "Actuation"), placeField(desk, "reset_mm", "Reset"), onsetField(desk))),
    panel("Control points", h("p", { class: "muted" }, () => wordsOf(desk.active())), pointsTable(desk)),
  ];
}

function placeField(desk: Desk, which: ModelNumber, label: string): HTMLElement {
  return numberField({
    label,
    unit: "mm",
    value: () => desk.model()[which],
    set: (value) => void desk.apply(setNumber(which, value), which),
    step: 0.05,
    least: 0,
    digits: 4,
  });
}

function onsetField(desk: Desk): HTMLElement {
  const onset = () => placeHandles(desk.model(), desk.active()).find(({ name }) => name === "onset");
  return numberField({
    label: "Vibration",
    unit: "mm",
    value: () => onset()?.at_mm ?? null,
    set: (value) => {
      const found = onset();
      if (found) desk.apply(found.edit(value), "onset");
    },
    step: 0.05,
    least: 0,
    digits: 4,
    disabled: () => !onset(),
  });
}

/** What every drag and number respects. */
export function limitsPanel(desk: Desk): HTMLElement {
  return panel("Edits respect", limits(desk));
}

function limits(desk: Desk): HTMLElement {
  const { constraints } = desk;
  return h(
    "div",
    { class: "edit-limits" },
    toggle({ label: "Never falls", value: () => constraints().monotone === "rising", set: (on) => change(constraints, "monotone", on ? "rising" : undefined), hint: "The curve rises or stays; no bump" }),
    toggle({ label: "Keep the work", value: () => constraints().keepWork === true, set: (on) => change(constraints, "keepWork", on || undefined), hint: "The other points move so that the area under the curve stays" }),
    toggle({ label: "Keep the ends", value: () => constraints().keepEnds === true, set: (on) => change(constraints, "keepEnds", on || undefined), hint: "First and last control point stay" }),
    numberField({ label: "Steps of", unit: "cN", value: () => constraints().step_cN ?? 0, set: (step) => change(constraints, "step_cN", step || undefined), least: 0, most: 100, digits: 3, step: 0.5 }),
  );
}

function change<K extends keyof Constraints>(all: Signal<Constraints>, name: K, value: Constraints[K] | undefined): void {
  const { [name]: _old, ...rest } = all.peek();
  all.set(value === undefined ? rest : { ...rest, [name]: value });
}

