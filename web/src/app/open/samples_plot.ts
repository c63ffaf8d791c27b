/** The raw samples of a file as dots, under the curves that were fitted to them. */

import { type Brush, type Layer, Plot, palette, RELEASE_DASH, velocityColour } from "../../draw";
import type { Held } from "./opening";

const HEIGHT_px = 230;
const DOT_px = 2.6;
/** Of all strokes together: more than the eye separates. */
const MOST_DOTS = 6000;

export function samplesPlot(button: Held): Plot {
  const curves = button.strokes.map((stroke) => ({
    ...stroke,
    x_mm: stroke.force_cN.map((_, i) => stroke.start_mm + i * stroke.step_mm),
  }));
  const count = button.samples.reduce((sum, { force_cN }) => sum + force_cN.length, 0);
  const every = Math.max(1, Math.ceil(count / MOST_DOTS));
  const still: Layer = (brush, view) => {
    const place = (x_mm: number, force_cN: number) => ({ x_px: view.x.px(x_mm), y_px: view.y.px(force_cN) });
    for (const { displacement_mm, force_cN } of button.samples)
      for (let i = 0; i < force_cN.length; i += every) dot(brush, place(displacement_mm[i]!, force_cN[i]!));
    for (const { x_mm, force_cN, stroke, velocity_mm_s } of curves)
      brush.line(x_mm.map(view.x.px), force_cN.map(view.y.px), {
        colour: velocityColour(velocity_mm_s),
        dash: stroke === "release" ? RELEASE_DASH : [],
        width_px: 1.5,
      });
  };
  return new Plot({
    label: `Force over displacement of ${button.name}, samples and fit`,
    x: { label: "displacement from contact", unit: "mm" },
    y: { label: "force", unit: "cN" },
    whole: () => whole(curves),
    still,
    height_px: HEIGHT_px,
  });
}

function dot(brush: Brush, at: { readonly x_px: number; readonly y_px: number }): void {
  brush.circle(at, DOT_px, { colour: palette().muted, opacity: 0.3 });
}

/** What the curves take: samples beyond, of the stop, would leave them flat. */
function whole(curves: readonly { readonly x_mm: number[]; readonly force_cN: readonly number[] }[]) {
  const forces = curves.flatMap((curve) => curve.force_cN);
  const [low, high] = [Math.min(0, ...forces), Math.max(1, ...forces)];
  const air = 0.08 * (high - low);
  const last_mm = Math.max(0.1, ...curves.map(({ x_mm }) => x_mm.at(-1) ?? 0));
  return { x: { low: -0.04 * last_mm, high: 1.04 * last_mm }, y: { low: low - air / 2, high: high + air } };
}
