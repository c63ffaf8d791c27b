/** The figures that people compare buttons by: now, before, and how they differ. */

import { type Landmarks, landmarks } from "../../math";
import { curveAt } from "../../model";
import { computed, h, panel } from "../../ui";
import type { EditorController } from "./editor_controller";
import { wordsOf } from "./look";

interface Figure {
  readonly name: keyof Landmarks;
  readonly label: string;
  readonly unit: string;
  readonly digits: number;
}

const FIGURES: readonly Figure[] = [
  { name: "peak_cN", label: "Peak", unit: "cN", digits: 2 },
  { name: "peak_mm", label: "Peak at", unit: "mm", digits: 3 },
  { name: "valley_cN", label: "Valley", unit: "cN", digits: 2 },
  { name: "valley_mm", label: "Valley at", unit: "mm", digits: 3 },
  { name: "snap_ratio", label: "Snap ratio", unit: "", digits: 3 },
  { name: "release_peak_cN", label: "Release peak", unit: "cN", digits: 2 },
  { name: "release_valley_cN", label: "Release valley", unit: "cN", digits: 2 },
  { name: "actuation_cN", label: "Force at actuation", unit: "cN", digits: 2 },
  { name: "pre_travel_mm", label: "Before actuation", unit: "mm", digits: 3 },
  { name: "post_travel_mm", label: "After actuation", unit: "mm", digits: 3 },
  { name: "bottom_out_cN", label: "Bottom-out", unit: "cN", digits: 2 },
  { name: "preload_cN", label: "Preload", unit: "cN", digits: 2 },
  { name: "pre_slope_cN_mm", label: "Slope before", unit: "cN/mm", digits: 1 },
  { name: "steepest_fall_cN_mm", label: "Steepest fall", unit: "cN/mm", digits: 1 },
  { name: "post_slope_cN_mm", label: "Slope at the end", unit: "cN/mm", digits: 1 },
  { name: "work_mJ", label: "Work of the press", unit: "mJ", digits: 4 },
  { name: "release_work_mJ", label: "Work returned", unit: "mJ", digits: 4 },
  { name: "hysteresis_loss_mJ", label: "Hysteresis loss", unit: "mJ", digits: 4 },
];

/** The panel. */
export function figuresPanel(editor: EditorController): HTMLElement {
  const before = computed(() => {
    const [model, at] = [editor.before(), editor.active()];
    return model.curves.some((c) => c.stroke === "press") && curveAt(model, at)
      ? landmarks(model, at.velocity_mm_s)
      : null;
  });
  const rows = FIGURES.map((figure) => row(editor, figure, before));
  const head = ["", "now", "before", "change"].map((name, i) =>
    h("th", { scope: "col", class: i ? "number" : "" }, name),
  );
  return panel(
    "Figures",
    h(
      "p",
      { class: "muted" },
      () => `for ${wordsOf({ ...editor.active(), stroke: "press" })} and its release`,
    ),
    h("table", { class: "edit-figures" }, h("thead", {}, h("tr", {}, head)), h("tbody", {}, rows)),
  );
}

function row(
  editor: EditorController,
  { name, label, unit, digits }: Figure,
  before: () => Landmarks | null,
): HTMLElement {
  const value = (of: Landmarks | null) => of?.[name] ?? null;
  const text = (n: number | null) => (n === null ? "–" : n.toFixed(digits).replace("-", "−"));
  const change = () => {
    const [now, then] = [value(editor.landmarks()), value(before())];
    if (now === null || then === null) return now === then ? "" : "new or gone";
    const by = now - then;
    if (Math.abs(by) < 0.5 * 10 ** -digits) return "";
    return `${by > 0 ? "+" : "−"}${Math.abs(by).toFixed(digits)}`;
  };
  return h(
    "tr",
    {},
    h("th", { scope: "row" }, label, unit ? h("span", { class: "unit" }, ` ${unit}`) : null),
    h("td", { class: "number" }, () => text(value(editor.landmarks()))),
    h("td", { class: "number muted" }, () => text(value(before()))),
    h("td", { class: () => `number${change() ? " edit-changed" : ""}` }, change),
  );
}
