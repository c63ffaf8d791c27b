/** The handles of the canvas: places of the travel that are dragged sideways, bumps that are dragged up and down. */

import type { Brush, View } from "../../draw";
import { palette } from "../../draw";
import {
  basis,
  bumpOf,
  type Constraints,
  end_mm,
  findSpan,
  nearestVibration,
  type Spline,
  snap,
  start_mm,
} from "../../math";
import {
  type CurveRef,
  type Edit,
  type FDVVModel,
  type ForceCurve,
  setNumber,
  setOnset,
  setPoints,
} from "../../model";
import type { HandleShown } from "../../tools/reach";
import { force } from "../../ui/force";
import { forceNear_cN, sampled } from "./samples";

/** A handle at a position of the travel. */
export interface PositionHandle {
  readonly name: "actuation" | "reset" | "onset" | "travel";
  readonly label: string;
  readonly at_mm: number;
  readonly edit: (at_mm: number) => Edit;
}

/** Places of the travel are rounded to this while they are dragged. */
const RASTER_mm = 0.01;
const ROW_px = 20;

/** The handles of a model; the onset is that of the vibration that serves the active curve. */
export function positionHandles(model: FDVVModel, active: CurveRef): PositionHandle[] {
  const handles: PositionHandle[] = [];
  const add = (
    name: PositionHandle["name"],
    label: string,
    at_mm: number | null,
    edit: PositionHandle["edit"],
  ) => {
    if (at_mm !== null) handles.push({ name, label, at_mm, edit });
  };
  add("travel", "travel", model.travel_mm, (at) => setNumber("travel_mm", at));
  add("actuation", "actuation", model.actuation_mm, (at) => setNumber("actuation_mm", at));
  add("reset", "reset", model.reset_mm, (at) => setNumber("reset_mm", at));
  const vibration = nearestVibration(model.vibrations, active.stroke, active.velocity_mm_s ?? 0);
  if (vibration) add("onset", "vibration", vibration.onset_mm, (at) => setOnset(vibration, at));
  return handles;
}

/** Where a dragged handle may stand. */
export function clampedPosition(
  model: FDVVModel,
  name: PositionHandle["name"],
  at_mm: number,
  raster_mm = RASTER_mm,
): number {
  const most = name === "travel" ? 20 : model.travel_mm;
  const least = name === "travel" ? Math.max(0.1, model.actuation_mm ?? 0, model.reset_mm ?? 0) : 0;
  return snap(Math.min(most, Math.max(least, at_mm)), raster_mm);
}

/** Peak and valley of a curve, as handles that are dragged up and down. */
export function bumpHandles(
  curve: ForceCurve,
  travel_mm: number,
): { name: "peak" | "valley"; x_mm: number; force_cN: number }[] {
  const bump = bumpOf(curve, travel_mm);
  if (!bump) return [];
  return [
    { name: "peak", x_mm: bump.peak_mm, force_cN: bump.peak_cN },
    { name: "valley", x_mm: bump.valley_mm, force_cN: bump.valley_cN },
  ];
}

/** The edit that pulls a curve at a place by a force, with the smallest change of its control points. */
export function pullEdit(curve: ForceCurve, x_mm: number, by_cN: number, constraints: Constraints): Edit {
  const inside = Math.min(end_mm(curve), Math.max(start_mm(curve), x_mm));
  const weights = basisAt(curve, inside);
  const squared = weights.reduce((sum, [, w]) => sum + w * w, 0);
  const values_cN = weights.map(
    ([i, w]) => [i, curve.control_points_cN[i]! + (by_cN * w) / squared] as const,
  );
  const { stroke, velocity_mm_s } = curve;
  return setPoints([{ stroke, velocity_mm_s, values_cN }], constraints);
}

/** Where the handles lie on the canvas: places in rows at its top, bumps on the curve. */
export function handlesOnCanvas(view: View, model: FDVVModel, curve: ForceCurve): HandleShown[] {
  const rows = positionHandles(model, curve).map((handle, row) => ({
    name: handle.name,
    x_px: view.x.px(handle.at_mm),
    y_px: rowOf(view, row),
  }));
  const bumps = bumpHandles(curve, model.travel_mm).map(({ name, x_mm }) => ({
    name,
    x_px: view.x.px(x_mm),
    y_px: view.y.px(forceNear_cN(sampled(curve), x_mm)) + (name === "peak" ? -16 : 16),
  }));
  return [...rows, ...bumps];
}

/** Travel, actuation, reset and vibration. */
const PLACES = 4;
/** About how wide a letter is in words of 11 px. */
const LETTER_px = 5.8;

function rowOf(view: View, row: number): number {
  return view.box.top + ROW_px * (row + 0.5);
}

/** Lines and grips of the places, with their numbers. */
export function paintPositions(
  brush: Brush,
  view: View,
  model: FDVVModel,
  active: CurveRef,
  held: string | null,
): void {
  const { text, muted, surface, accent } = palette();
  const bottom = view.box.top + view.box.height;
  positionHandles(model, active).forEach(({ name, label, at_mm }, row) => {
    const [x, y] = [view.x.px(at_mm), rowOf(view, row)];
    const colour = name === held ? accent : muted;
    brush.line([x, x], [y, bottom], { colour, dash: name === "reset" ? [2, 4] : [6, 4], opacity: 0.8 });
    brush.circle({ x_px: x, y_px: y }, 5.5, { colour: surface }, { colour, width_px: 2 });
    const [before, behind] = [x - view.box.left, view.box.left + view.box.width - x];
    const full = `${label} ${at_mm.toFixed(2)} mm`;
    const fits = (room_px: number) => 16 + LETTER_px * full.length < room_px;
    // to the right, unless only the left has room; the axis says the unit where neither has
    const words = fits(before) || fits(behind) ? full : `${label} ${at_mm.toFixed(2)}`;
    const right = fits(behind) || (!fits(before) && behind > before);
    const at = { x_px: x + (right ? 10 : -10), y_px: y };
    brush.text(words, at, {
      colour: text,
      size_px: 11,
      align: right ? "left" : "right",
      halo: surface,
    });
  });
}

/** Peak, valley and the force at the end of the travel, with their numbers. */
export function paintBumps(brush: Brush, view: View, curve: ForceCurve, travel_mm: number): void {
  const { text, surface, accent } = palette();
  for (const { name, x_mm, force_cN } of bumpHandles(curve, travel_mm)) {
    const up = name === "peak" ? -1 : 1;
    const x = view.x.px(x_mm);
    const y = view.y.px(forceNear_cN(sampled(curve), x_mm));
    const [tip, base] = [y + up * 10, y + up * 19];
    brush.area([x, x - 6, x + 6], [tip, base, base], { colour: accent });
    // the rows of the places come first
    const words = `${name} ${force(force_cN)} at ${x_mm.toFixed(2)} mm`;
    const half_px = 0.5 * LETTER_px * words.length;
    const last_px = view.box.left + view.box.width - half_px;
    const at = {
      x_px: Math.max(view.box.left + half_px, Math.min(last_px, x)),
      y_px: Math.max(y + up * 30, rowOf(view, PLACES - 0.4)),
    };
    brush.rect(
      { left: at.x_px - half_px, top: at.y_px - 7, width: 2 * half_px, height: 14 },
      { colour: surface, opacity: 0.85 },
    );
    brush.text(words, at, { colour: text, size_px: 11, align: "center" });
  }
  const end = forceNear_cN(sampled(curve), travel_mm);
  const [y, rows] = [view.y.px(end), rowOf(view, PLACES)];
  // the rows of the places come first: below the curve where both would be in one line
  const at = { x_px: view.x.px(travel_mm) - 12, y_px: y - 14 < rows ? y + 18 : y - 14 };
  brush.text(`bottom-out ${force(end)}`, at, {
    colour: text,
    size_px: 11,
    align: "right",
    halo: surface,
  });
}

/** Index and weight of the control points that move a curve at a place; the weights sum to 1. */
function basisAt(curve: Spline, x_mm: number): (readonly [number, number])[] {
  const { degree: k, knots_mm: t } = curve;
  const span = findSpan(t, k, x_mm);
  const values = new Float64Array(k + 1);
  basis(t, k, span, x_mm, values);
  return Array.from(values, (weight, i) => [span - k + i, weight] as const).filter(
    ([, weight]) => weight > 0,
  );
}
