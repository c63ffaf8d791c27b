/** The curves of the button as a table of velocities and strokes: choose, add, remove. */

import { STROKES, type Stroke } from "../../math";
import { type CurveRef, copyCurve, copyStroke, curveAt, removeCurve, setVelocity } from "../../model";
import { button, h, numberField, panel, svg } from "../../ui";
import { type EditorController, refOf } from "./editor_controller";
import { bumpHandles } from "./handles";
import { lineOf, longName, wordsOf } from "./look";
import { filled } from "./rows";

/** The panel. */
export function curvesPanel(editor: EditorController): HTMLElement {
  return panel("Curves", table(editor), actions(editor), speeds(editor));
}

function table(editor: EditorController): HTMLElement {
  const head = h(
    "tr",
    {},
    h("th", { scope: "col" }, "mm/s"),
    STROKES.map((stroke) => h("th", { scope: "col" }, arrow(stroke))),
  );
  const rows = () =>
    editor.velocities().map((velocity_mm_s) =>
      h(
        "tr",
        {},
        h(
          "th",
          { scope: "row", "aria-label": longName({ stroke: "press", velocity_mm_s }) },
          velocity_mm_s ?? "?",
        ),
        STROKES.map((stroke) => h("td", {}, () => cell(editor, { stroke, velocity_mm_s }))),
      ),
    );
  return h(
    "table",
    { class: "edit-curves", "aria-label": "Curves by speed and stroke" },
    h("thead", {}, head),
    filled(h("tbody", {}), rows),
  );
}

function arrow(stroke: Stroke): string {
  return stroke === "press" ? "↓ press" : "↑ release";
}

/** A curve to choose, or the place of one that is not there. */
function cell(editor: EditorController, at: CurveRef): HTMLElement {
  const there = editor
    .settled()
    .curves.some((c) => c.stroke === at.stroke && c.velocity_mm_s === at.velocity_mm_s);
  if (!there) return adder(editor, at);
  const active = () =>
    editor.active().stroke === at.stroke && editor.active().velocity_mm_s === at.velocity_mm_s;
  const peak = () => {
    const curve = curveAt(editor.settled(), at);
    const bump = curve && bumpHandles(curve, editor.settled().travel_mm)[0];
    return bump ? `${bump.force_cN.toFixed(0)} cN` : "–";
  };
  return h(
    "button",
    {
      type: "button",
      class: "edit-curve",
      "aria-pressed": () => String(active()),
      "aria-label": () => `${wordsOf(at)}, peak ${peak()}`,
      on: { click: () => editor.activate(at) },
    },
    () => swatch(editor, at),
    peak,
  );
}

function adder(editor: EditorController, at: CurveRef): HTMLElement {
  const act = () => {
    if (editor.apply(copyCurve(editor.active.peek(), at))) editor.activate(at);
  };
  return button({
    label: `Add ${wordsOf(at)} as a copy of the active curve`,
    glyph: "+",
    kind: "quiet",
    act,
  });
}

function swatch(editor: EditorController, at: CurveRef): SVGSVGElement {
  const line = lineOf(editor.velocities(), at);
  const props = {
    x1: 0,
    x2: 22,
    y1: 5,
    y2: 5,
    stroke: line.colour,
    "stroke-width": 2.5,
    "stroke-dasharray": (line.dash ?? []).join(" "),
  };
  return svg("svg", { width: 22, height: 10, "aria-hidden": "true" }, svg("line", props));
}

function actions(editor: EditorController): HTMLElement {
  const otherStroke = () => (editor.active().stroke === "press" ? "release" : "press");
  const mirrored = () => {
    const { stroke, velocity_mm_s } = editor.active.peek();
    const to = { stroke: stroke === "press" ? "release" : "press", velocity_mm_s } as const;
    if (editor.apply(copyCurve({ stroke, velocity_mm_s }, to))) editor.activate(to);
  };
  const remove = () => void editor.apply(removeCurve(editor.active.peek()));
  return h(
    "div",
    { class: "row" },
    h(
      "button",
      { type: "button", class: "button plain", on: { click: mirrored } },
      () => `Copy to ${otherStroke()}`,
    ),
    h(
      "button",
      {
        type: "button",
        class: "button plain",
        on: {
          click: () =>
            void editor.apply(
              copyStroke(
                editor.active.peek().stroke,
                editor.active.peek().stroke === "press" ? "release" : "press",
              ),
            ),
        },
      },
      () => `All to ${otherStroke()}`,
    ),
    button({
      label: "Remove",
      kind: "danger",
      act: remove,
      disabled: () => editor.settled().curves.length < 2,
      hint: "Remove the active curve",
    }),
  );
}

/** The active curve's speed, and a copy of it at another one. */
function speeds(editor: EditorController): HTMLElement {
  const bounds = { unit: "mm/s", least: 0.01, most: 2000, digits: 3, step: 10 } as const;
  const retime = (value: number) => {
    const { stroke } = editor.active.peek();
    if (editor.apply(setVelocity(editor.active.peek(), value)))
      editor.activate({ stroke, velocity_mm_s: value });
  };
  const copy = (value: number) => {
    const from = refOf(editor.active.peek());
    const to = { stroke: from.stroke, velocity_mm_s: value };
    if (editor.apply(copyCurve(from, to))) editor.activate(to);
  };
  return h(
    "div",
    { class: "edit-fields" },
    numberField({ ...bounds, label: "Speed", value: () => editor.active().velocity_mm_s, set: retime }),
    numberField({ ...bounds, label: "Copy to", value: () => null, set: copy }),
  );
}
