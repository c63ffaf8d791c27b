/** The editor's canvas: every curve of the button, the active one in the hand. */

import { type DataPoint, palette, Plot, type Range, type View } from "../../draw";
import { curveAt } from "../../model";
import { computed, effect, h, type Signal, signal } from "../../ui";
import type { Desk } from "./desk";
import { paintBumps, paintPlaces } from "./handles";
import { lineOf } from "./look";
import * as paint from "./paint";
import { readout } from "./readout";
import type { RigView } from "./rigs";
import { forceNear_cN, sampled } from "./samples";
import { timed } from "./timing";

/** A box that is being drawn, px. */
export interface BoxDrawn {
  readonly from: { readonly x_px: number; readonly y_px: number };
  readonly to: { readonly x_px: number; readonly y_px: number };
}

/** What the hand does on the canvas, as far as it is drawn. */
export interface HandShown {
  readonly hover: Signal<DataPoint | null>;
  readonly box: Signal<BoxDrawn | null>;
  readonly held: Signal<string | null>;
}

/** The canvas, and what is shown of the hand on it. */
export interface EditorCanvas extends HandShown {
  readonly plot: Plot;
  readonly element: HTMLElement;
}

/** Make the canvas. */
export function editorCanvas(desk: Desk, rig: RigView): EditorCanvas {
  const hand: HandShown = { hover: signal<DataPoint | null>(null), box: signal<BoxDrawn | null>(null), held: signal<string | null>(null) };
  const plot = new Plot({
    label: "Force over displacement: drag the control points of the active curve",
    x: { label: "displacement", unit: "mm" },
    y: { label: "force", unit: "cN" },
    whole: wholeOf(desk),
    still: (brush, view) => paintStill(desk, rig, brush, view),
    moving: (brush, view) => timed("fdvv-draw", () => paintMoving(desk, rig, hand, brush, view)),
    zoom: true,
  });
  plot.element.classList.add("edit-plot");
  plot.element.setAttribute("role", "application");
  const element = h("div", { class: "edit-canvas" }, readout(desk, rig, hand), h("div", { class: "edit-stage" }, plot.element));
  return { ...hand, plot, element };
}

/** Everything there is to see, with room above for the handles of places; it stays while a drag goes on, so that the axes do not run from the hand. */
function wholeOf(desk: Desk): () => { readonly x: Range; readonly y: Range } {
  const ranges = signal(rangesOf(desk));
  effect(() => ranges.set(rangesOf(desk)));
  return computed(() => ranges());
}

function rangesOf(desk: Desk): { readonly x: Range; readonly y: Range } {
  const model = desk.settled();
  let [low, high, far] = [0, 10, model.travel_mm];
  for (const curve of model.curves) {
    const { x_mm, force_cN } = sampled(curve);
    far = Math.max(far, x_mm[x_mm.length - 1]!);
    for (const force of force_cN) [low, high] = [Math.min(low, force), Math.max(high, force)];
    for (const force of curve.control_points_cN) [low, high] = [Math.min(low, force), Math.max(high, force)];
  }
  const air = 0.08 * (high - low);
  return { x: { low: -0.03 * far, high: far * 1.06 }, y: { low: low < 0 ? low - air : -0.6 * air, high: high + 3.4 * air } };
}

type Brush = Parameters<typeof paint.paintBefore>[0];

function paintStill(desk: Desk, rig: RigView, brush: Brush, view: View): void {
  const { stroke, velocity_mm_s } = desk.active();
  const before = desk.showBefore() ? curveAt(desk.before(), { stroke, velocity_mm_s }) : null;
  paint.paintOthers(brush, view, desk.others(), desk.velocities());
  if (before) paint.paintBefore(brush, view, before);
  for (const one of rig.measured()?.curves ?? []) {
    if (one.stroke !== stroke || one.velocity_mm_s !== velocity_mm_s) continue;
    paint.paintMeasured(brush, view, one.displacement_mm, [one.low_cN, one.median_cN, one.high_cN]);
  }
}

function paintMoving(desk: Desk, rig: RigView, hand: HandShown, brush: Brush, view: View): void {
  const [model, curve, velocities] = [desk.model(), desk.curve(), desk.velocities()];
  const span = desk.span();
  if (span) paint.paintSpan(brush, view, span.from_mm, span.to_mm);
  const made = rig.curves().find((one) => one.stroke === curve.stroke);
  for (const { start_mm, end_mm, limit } of made?.limited ?? [])
    paint.paintHatched(brush, view, start_mm, end_mm, limit === "force" ? "force limit" : "slew limit");
  paintPlaces(brush, view, model, curve, hand.held());
  paint.paintActive(brush, view, curve, velocities, desk.selection());
  if (made) paint.paintAchievable(brush, view, made.displacement_mm, made.achievable_cN);
  paint.paintName(brush, view, curve, velocities, true);
  paintBumps(brush, view, curve, model.travel_mm);
  paintHand(desk, hand, brush, view);
}

/** The cross under the pointer and the box that is drawn. */
function paintHand(desk: Desk, hand: HandShown, brush: Brush, view: View): void {
  const { accent, muted } = palette();
  const [hover, box] = [hand.hover(), hand.box()];
  if (box) {
    const [left, right] = [Math.min(box.from.x_px, box.to.x_px), Math.max(box.from.x_px, box.to.x_px)];
    const [top, bottom] = [Math.min(box.from.y_px, box.to.y_px), Math.max(box.from.y_px, box.to.y_px)];
    brush.rect({ left, top, width: right - left, height: bottom - top }, { colour: accent, opacity: 0.12 }, { colour: accent, dash: [4, 3] });
  } else if (hover) {
    const [x, y] = [view.x.px(hover.x), view.y.px(hover.y)];
    const on = view.y.px(forceNear_cN(sampled(desk.curve()), hover.x));
    brush.line([x, x], [view.box.top, view.box.top + view.box.height], { colour: muted, opacity: 0.5 });
    brush.line([view.box.left, view.box.left + view.box.width], [y, y], { colour: muted, opacity: 0.5 });
    const { colour } = lineOf(desk.velocities(), desk.curve());
    brush.circle({ x_px: x, y_px: on }, 3, { colour });
  }
}
