/** The editor's canvas: every curve of the button, and the line of numbers above it. */

import { type DataPoint, Plot, palette, type Range, type View } from "../../draw";
import { curveAt } from "../../model";
import { computed, effect, force, h, type Signal, signal } from "../../ui";
import type { EditorController } from "./editor_controller";
import { paintBumps, paintPositions } from "./handles";
import { lineOf, wordsOf } from "./look";
import * as paint from "./paint";
import type { RigView } from "./rigs";
import { forceNear_cN, sampled } from "./samples";
import { timed } from "./timing";

/** A box that is being drawn, px. */
export interface BoxDrawn {
  readonly from: { readonly x_px: number; readonly y_px: number };
  readonly to: { readonly x_px: number; readonly y_px: number };
}

/** What is drawn of the pointer: hover, selection box, dragged handle. */
export interface PointerOverlay {
  readonly hover: Signal<DataPoint | null>;
  readonly box: Signal<BoxDrawn | null>;
  readonly held: Signal<string | null>;
}

/** The canvas, and what is drawn of the pointer on it. */
export interface EditorCanvas extends PointerOverlay {
  readonly plot: Plot;
  readonly element: HTMLElement;
}

/** Make the canvas. */
export function editorCanvas(editor: EditorController, rig: RigView): EditorCanvas {
  const pointer: PointerOverlay = {
    hover: signal<DataPoint | null>(null),
    box: signal<BoxDrawn | null>(null),
    held: signal<string | null>(null),
  };
  const plot = new Plot({
    label: "Force over displacement: drag the control points of the active curve",
    x: { label: "displacement", unit: "mm" },
    y: { label: "force", unit: "cN" },
    whole: wholeOf(editor, rig),
    ends: computed(() => paint.velocityNames(editor.model().curves, editor.curve())),
    still: (brush, view) => paintStill(editor, rig, brush, view),
    moving: (brush, view) => timed("fdvv-draw", () => paintMoving(editor, rig, pointer, brush, view)),
    zoom: true,
  });
  plot.element.classList.add("edit-plot");
  plot.element.setAttribute("role", "application");
  const element = h(
    "div",
    { class: "edit-canvas" },
    readout(editor, rig, pointer),
    h("div", { class: "edit-stage" }, plot.element),
  );
  return { ...pointer, plot, element };
}

/** Everything there is to see, with room above for the handles of places; it stays while a drag goes on, so that the axes do not run from the hand. */
function wholeOf(editor: EditorController, rig: RigView): () => { readonly x: Range; readonly y: Range } {
  const ranges = signal(rangesOf(editor, []));
  effect(() => {
    const forces = [
      ...rig.curves().flatMap((one) => one.achievable_cN),
      ...(rig.measured()?.curves ?? []).flatMap((one) => [...one.low_cN, ...one.high_cN]),
    ];
    editor.settled();
    if (!editor.store.history.dragging) ranges.set(rangesOf(editor, forces));
  });
  return computed(() => ranges());
}

/** forces_cN : what else is drawn, such as what a rig renders. */
function rangesOf(
  editor: EditorController,
  forces_cN: readonly number[],
): { readonly x: Range; readonly y: Range } {
  const model = editor.settled();
  let [low, high, far] = [0, 10, model.travel_mm];
  for (const curve of model.curves) {
    const { x_mm, force_cN } = sampled(curve);
    far = Math.max(far, x_mm[x_mm.length - 1]!);
    for (const force of force_cN) [low, high] = [Math.min(low, force), Math.max(high, force)];
    for (const force of curve.control_points_cN) [low, high] = [Math.min(low, force), Math.max(high, force)];
  }
  for (const force of forces_cN)
    if (Number.isFinite(force)) [low, high] = [Math.min(low, force), Math.max(high, force)];
  const air = 0.08 * (high - low);
  return {
    x: { low: -0.03 * far, high: far * 1.06 },
    y: { low: low < 0 ? low - air : -0.6 * air, high: high + 3.4 * air },
  };
}

type Brush = Parameters<typeof paint.paintBefore>[0];

function paintStill(editor: EditorController, rig: RigView, brush: Brush, view: View): void {
  const { stroke, velocity_mm_s } = editor.active();
  const before = editor.showBefore() ? curveAt(editor.before(), { stroke, velocity_mm_s }) : null;
  const every = editor.everySpeed();
  paint.paintOthers(brush, view, editor.others(), (curve) => every && curve.stroke === stroke);
  if (before) paint.paintBefore(brush, view, before);
  for (const one of rig.measured()?.curves ?? []) {
    if (one.stroke !== stroke || one.velocity_mm_s !== velocity_mm_s) continue;
    paint.paintMeasured(brush, view, one.displacement_mm, [one.low_cN, one.median_cN, one.high_cN]);
  }
}

function paintMoving(
  editor: EditorController,
  rig: RigView,
  pointer: PointerOverlay,
  brush: Brush,
  view: View,
): void {
  const [model, curve] = [editor.model(), editor.curve()];
  const span = editor.span();
  if (span) paint.paintSpan(brush, view, span.from_mm, span.to_mm);
  const made = rig.curves().find((one) => one.stroke === curve.stroke);
  for (const { start_mm, end_mm, limit } of made?.limited ?? [])
    paint.paintHatched(brush, view, start_mm, end_mm, limit === "force" ? "force limit" : "slew limit");
  paintPositions(brush, view, model, curve, pointer.held());
  paint.paintActive(brush, view, curve, editor.selection());
  if (made) paint.paintAchievable(brush, view, made.displacement_mm, made.achievable_cN);
  paintBumps(brush, view, curve, model.travel_mm);
  paintPointer(editor, pointer, brush, view);
}

/** The cross under the pointer and the box that is drawn. */
function paintPointer(editor: EditorController, pointer: PointerOverlay, brush: Brush, view: View): void {
  const { accent, muted } = palette();
  const [hover, box] = [pointer.hover(), pointer.box()];
  if (box) {
    const [left, right] = [Math.min(box.from.x_px, box.to.x_px), Math.max(box.from.x_px, box.to.x_px)];
    const [top, bottom] = [Math.min(box.from.y_px, box.to.y_px), Math.max(box.from.y_px, box.to.y_px)];
    brush.rect(
      { left, top, width: right - left, height: bottom - top },
      { colour: accent, opacity: 0.12 },
      { colour: accent, dash: [4, 3] },
    );
  } else if (hover) {
    const [x, y] = [view.x.px(hover.x), view.y.px(hover.y)];
    const on = view.y.px(forceNear_cN(sampled(editor.curve()), hover.x));
    brush.line([x, x], [view.box.top, view.box.top + view.box.height], { colour: muted, opacity: 0.5 });
    brush.line([view.box.left, view.box.left + view.box.width], [y, y], { colour: muted, opacity: 0.5 });
    const { colour } = lineOf(editor.curve());
    brush.circle({ x_px: x, y_px: on }, 3, { colour });
  }
}

/** Numbers under the pointer; why a move goes no further, where it does not. */
function readout(editor: EditorController, rig: RigView, pointer: PointerOverlay): HTMLElement {
  const position = () => {
    const at = pointer.hover();
    if (!at) return wordsOf(editor.active());
    const curve_cN = forceNear_cN(sampled(editor.curve()), at.x);
    return `${at.x.toFixed(3)} mm · ${force(at.y)} · curve ${force(curve_cN, 2)}`;
  };
  return h(
    "div",
    { class: "edit-readout" },
    h("span", { class: "edit-pointer", "aria-hidden": "true" }, position),
    h("span", { class: "wrong", role: "status" }, () => editor.refusal()),
    legend(editor, rig),
  );
}

/** What the lines are, for those that are there. */
function legend(editor: EditorController, rig: RigView): HTMLElement {
  const key = (kind: string, text: string) => h("span", { class: `edit-key ${kind}` }, text);
  return h("span", { class: "edit-legend" }, () => {
    const measured = rig.measured();
    const at = editor.active();
    const here = measured?.curves.some((c) => c.stroke === at.stroke && c.velocity_mm_s === at.velocity_mm_s);
    return [
      editor.showBefore() ? key("before", "before") : null,
      rig.curves().length ? key("achievable", "achievable, computed") : null,
      here ? key("measured", measured?.simulated ? "measured, simulated" : "measured") : null,
    ];
  });
}
