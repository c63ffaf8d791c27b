/** The curves of the button as a table of velocities and strokes: choose, add, remove. */

import { STROKES, type Stroke } from "../../math";
import { copyCurve, copyStroke, type CurveRef, curveAt, removeCurve, setVelocity } from "../../model";
import { button, h, numberField, panel, svg } from "../../ui";
import { type Desk, refOf } from "./desk";
import { bumpHandles } from "./handles";
import { lineOf, longName, wordsOf } from "./look";
import { filled } from "./rows";

/** The panel. */
export function curvesPanel(desk: Desk): HTMLElement {
  return panel("Curves", table(desk), actions(desk), speeds(desk));
}

function table(desk: Desk): HTMLElement {
  const head = h("tr", {}, h("th", { scope: "col" }, "mm/s"), STROKES.map((stroke) => h("th", { scope: "col" }, arrow(stroke))));
  const rows = () =>
    desk.velocities().map((velocity_mm_s) =>
      h(
        "tr",
        {},
        h("th", { scope: "row", "aria-label": longName({ stroke: "press", velocity_mm_s }) }, velocity_mm_s ?? "?"),
        STROKES.map((stroke) => h("td", {}, () => cell(desk, { stroke, velocity_mm_s }))),
      ),
    );
  return h("table", { class: "edit-curves", "aria-label": "Curves by speed and stroke" }, h("thead", {}, head), filled(h("tbody", {}), rows));
}

function arrow(stroke: Stroke): string {
  return stroke === "press" ? "↓ press" : "↑ release";
}

/** A curve to choose, or the place of one that is not there. */
function cell(desk: Desk, at: CurveRef): HTMLElement {
  const there = desk.settled().curves.some((c) => c.stroke === at.stroke && c.velocity_mm_s === at.velocity_mm_s);
  if (!there) return adder(desk, at);
  const active = () => desk.active().stroke === at.stroke && desk.active().velocity_mm_s === at.velocity_mm_s;
  const peak = () => {
    const curve = curveAt(desk.settled(), at);
    const bump = curve && bumpHandles(curve, desk.settled().travel_mm)[0];
    return bump ? `${bump.force_cN.toFixed(0)} cN` : "–";
  };
  return h(
    "button",
    {
      type: "button",
      class: "edit-curve",
      "aria-pressed": () => String(active()),
      "aria-label": () => `${wordsOf(at)}, peak ${peak()}`,
      on: { click: () => desk.activate(at) },
    },
    () => swatch(desk, at),
    peak,
  );
}

function adder(desk: Desk, at: CurveRef): HTMLElement {
  const act = () => {
    if (desk.apply(copyCurve(desk.active.peek(), at))) desk.activate(at);
  };
  return button({ label: `Add ${wordsOf(at)} as a copy of the active curve`, glyph: "+", kind: "quiet", act });
}

function swatch(desk: Desk, at: CurveRef): SVGSVGElement {
  const line = lineOf(desk.velocities(), at);
  const props = { x1: 0, x2: 22, y1: 5, y2: 5, stroke: line.colour, "stroke-width": 2.5, "stroke-dasharray": (line.dash ?? []).join(" ") };
  return svg("svg", { width: 22, height: 10, "aria-hidden": "true" }, svg("line", props));
}

function actions(desk: Desk): HTMLElement {
  const otherStroke = () => (desk.active().stroke === "press" ? "release" : "press");
  const mirrored = () => {
    const { stroke, velocity_mm_s } = desk.active.peek();
    const to = { stroke: stroke === "press" ? "release" : "press", velocity_mm_s } as const;
    if (desk.apply(copyCurve({ stroke, velocity_mm_s }, to))) desk.activate(to);
  };
  const remove = () => void desk.apply(removeCurve(desk.active.peek()));
  return h(
    "div",
    { class: "row" },
    h("button", { type: "button", class: "button plain", on: { click: mirrored } }, () => `Copy to ${otherStroke()}`),
    h(
      "button",
      { type: "button", class: "button plain", on: { click: () => void desk.apply(copyStroke(desk.active.peek().stroke, desk.active.peek().stroke === "press" ? "release" : "press")) } },
      () => `All to ${otherStroke()}`,
    ),
    button({ label: "Remove", kind: "danger", act: remove, disabled: () => desk.settled().curves.length < 2, hint: "Remove the active curve" }),
  );
}

/** The active curve's speed, and a copy of it at another one. */
function speeds(desk: Desk): HTMLElement {
  const bounds = { unit: "mm/s", least: 0.01, most: 2000, digits: 3, step: 10 } as const;
  const retime = (value: number) => {
    const { stroke } = desk.active.peek();
    if (desk.apply(setVelocity(desk.active.peek(), value))) desk.activate({ stroke, velocity_mm_s: value });
  };
  const copy = (value: number) => {
    const from = refOf(desk.active.peek());
    const to = { stroke: from.stroke, velocity_mm_s: value };
    if (desk.apply(copyCurve(from, to))) desk.activate(to);
  };
  return h(
    "div",
    { class: "edit-fields" },
    numberField({ ...bounds, label: "Speed", value: () => desk.active().velocity_mm_s, set: retime }),
    numberField({ ...bounds, label: "Copy to", value: () => null, set: copy }),
  );
}
