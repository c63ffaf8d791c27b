/** Axes: grid, ticks, labels with their units. */

import { perUnit, unitText } from "../ui/force";
import type { Brush } from "./brush";
import { palette } from "./palette";
import { type Scale, tickStep, ticks, tickText } from "./scale";
import type { PlotOptions, View } from "./types";

const APART = { x_px: 80, y_px: 44 };

export function drawFrame(brush: Brush, view: View, options: PlotOptions): void {
  const { grid, muted } = palette();
  const { box } = view;
  const counts = { x: box.width / APART.x_px, y: box.height / APART.y_px };
  const [bottom, right] = [box.top + box.height, box.left + box.width];
  for (const [value, text] of marks(view.x, counts.x, options.x.unit)) {
    const at = view.x.px(value);
    brush.line([at, at], [box.top, bottom], { colour: grid });
    brush.text(
      text,
      { x_px: at, y_px: bottom + 6 },
      { colour: muted, align: "center", base: "top", size_px: 11 },
    );
  }
  for (const [value, text] of marks(view.y, counts.y, options.y.unit)) {
    const at = view.y.px(value);
    brush.line([box.left, right], [at, at], { colour: grid });
    brush.text(text, { x_px: box.left - 7, y_px: at }, { colour: muted, align: "right", size_px: 11 });
  }
  brush.line([box.left, box.left, right], [box.top, bottom, bottom], { colour: muted });
  if (!options.small) drawLabels(brush, view, options);
}

function drawLabels(brush: Brush, view: View, options: PlotOptions): void {
  const colour = palette().text;
  const { box } = view;
  const label = (axis: { label: string; unit: string }) =>
    axis.unit ? `${axis.label}, ${unitText(axis.unit)}` : axis.label;
  const below = { x_px: box.left + box.width / 2, y_px: view.height_px - 4 };
  const beside = { x_px: 12, y_px: box.top + box.height / 2 };
  brush.text(label(options.x), below, { colour, align: "center", base: "bottom" });
  brush.text(label(options.y), beside, { colour, align: "center", upwards: true });
}

/** Round values of the unit that is shown, as values of the axis, with their texts. */
function marks(scale: Scale, count: number, unit: string): [number, string][] {
  const per = perUnit(unit);
  const range = { low: scale.range.low * per, high: scale.range.high * per };
  const step = tickStep(range, count);
  return ticks(range, count).map((value) => [value / per, tickText(value, step)]);
}
