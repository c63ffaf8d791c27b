/** What the editor's canvas shows, stroke by stroke; every painter goes through a brush, so that it can be exported. */

import type { Brush, EndLabel, Stroke as Line, View } from "../../draw";
import { palette, velocityColour } from "../../draw";
import { controlPoints_mm } from "../../math";
import type { ForceCurve } from "../../model";
import { DIMMED, lineOf } from "./look";
import { inPixels, sampled } from "./samples";

/** A curve as a line. */
function paintCurve(brush: Brush, view: View, curve: ForceCurve, line: Line): void {
  const { x_mm, force_cN } = sampled(curve);
  brush.line(inPixels(view.x, x_mm), inPixels(view.y, force_cN), line);
}

/** The curves that are not edited: dimmed, but for those that follow. */
export function paintOthers(
  brush: Brush,
  view: View,
  curves: readonly ForceCurve[],
  follows: (curve: ForceCurve) => boolean,
): void {
  for (const curve of curves)
    paintCurve(brush, view, curve, {
      ...lineOf(curve),
      ...(follows(curve) ? { width_px: 2.2 } : { width_px: 1.4, opacity: DIMMED }),
    });
}

/** A name for each velocity where its curves end: press and release end together. */
export function velocityNames(curves: readonly ForceCurve[], active: ForceCurve): EndLabel[] {
  const at = [...new Map(curves.map((curve) => [curve.velocity_mm_s, curve])).keys()];
  return at.map((velocity_mm_s) => {
    const mine = velocity_mm_s === active.velocity_mm_s;
    const { x_mm, force_cN } = sampled(
      mine ? active : curves.find((c) => c.velocity_mm_s === velocity_mm_s)!,
    );
    return {
      text: velocity_mm_s === null ? "speed unknown" : `${velocity_mm_s} mm/s`,
      colour: velocityColour(velocity_mm_s),
      x: x_mm[x_mm.length - 1]!,
      y: force_cN[force_cN.length - 1]!,
      weight: mine ? 1 : 0,
    };
  });
}

/** The curve that is edited, its control polygon and its control points; selected ones are filled. */
export function paintActive(brush: Brush, view: View, curve: ForceCurve, selection: readonly number[]): void {
  const line = lineOf(curve);
  const { surface, text } = palette();
  paintCurve(brush, view, curve, { colour: surface, width_px: 6 });
  paintCurve(brush, view, curve, { ...line, width_px: 2.6 });
  const [x, y] = [inPixels(view.x, controlPoints_mm(curve)), inPixels(view.y, curve.control_points_cN)];
  brush.line(x, y, { colour: line.colour, width_px: 1, opacity: 0.45, dash: [2, 3] });
  x.forEach((x_px, i) => {
    const at = { x_px, y_px: y[i]! };
    if (selection.includes(i)) brush.circle(at, 6.5, { colour: line.colour }, { colour: text, width_px: 2 });
    else brush.circle(at, 4.5, { colour: surface }, { colour: line.colour, width_px: 2 });
  });
}

/** What was before: a pale line behind everything. */
export function paintBefore(brush: Brush, view: View, curve: ForceCurve): void {
  paintCurve(brush, view, curve, { colour: palette().muted, width_px: 1.6, dash: [1, 3] });
}

/** What a rig can achieve. */
export function paintAchievable(
  brush: Brush,
  view: View,
  x_mm: readonly number[],
  force_cN: readonly number[],
): void {
  const colour = palette().danger;
  brush.line(inPixels(view.x, x_mm), inPixels(view.y, force_cN), {
    colour,
    width_px: 1.8,
    dash: [10, 3, 2, 3],
  });
}

/** What presses gave: the band of the middle half and the median. */
export function paintMeasured(
  brush: Brush,
  view: View,
  x_mm: readonly number[],
  [low_cN, median_cN, high_cN]: readonly [readonly number[], readonly number[], readonly number[]],
): void {
  const colour = palette().good;
  const outline = [...x_mm, ...[...x_mm].reverse()];
  brush.area(inPixels(view.x, outline), inPixels(view.y, [...low_cN, ...[...high_cN].reverse()]), {
    colour,
    opacity: 0.22,
  });
  brush.line(inPixels(view.x, x_mm), inPixels(view.y, median_cN), { colour, width_px: 1.6, dash: [3, 2] });
}

/** A part of the travel, hatched from top to bottom, with a word at its foot. */
export function paintHatched(brush: Brush, view: View, from_mm: number, to_mm: number, word: string): void {
  const colour = palette().danger;
  const { box } = view;
  const [left, right] = [view.x.px(from_mm), Math.max(view.x.px(to_mm), view.x.px(from_mm) + 3)];
  const bottom = box.top + box.height;
  brush.rect({ left, top: box.top, width: right - left, height: box.height }, { colour, opacity: 0.07 });
  brush.clipped({ left, top: box.top, width: right - left, height: box.height }, () => {
    for (let x = left - box.height; x < right; x += 14)
      brush.line([x, x + box.height], [bottom, box.top], { colour, opacity: 0.25 });
  });
  brush.text(
    word,
    { x_px: (left + right) / 2, y_px: bottom - 8 },
    { colour, align: "center", size_px: 11, halo: palette().surface },
  );
}

/** A chosen part of the travel. */
export function paintSpan(brush: Brush, view: View, from_mm: number, to_mm: number): void {
  const colour = palette().accent;
  const [left, right] = [view.x.px(from_mm), view.x.px(to_mm)];
  const { top, height } = view.box;
  brush.rect(
    { left, top, width: right - left, height },
    { colour, opacity: 0.1 },
    { colour, opacity: 0.6, dash: [4, 3] },
  );
}
