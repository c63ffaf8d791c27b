/** A button's press and release, small: all on the same axes, so that rows can be compared at a glance. */

import { CanvasBrush, palette } from "../../draw";
import type { Rows } from "./rows";
import { SKETCH_POINTS } from "./rows";

export const SIZE_px = { width: 84, height: 44 } as const;
/** The axes of all thumbnails; a button that is longer or stronger is scaled to fit. */
const TRAVEL_mm = 4.2;
const FORCE_cN = 110;
const PAD_px = 2;

export function drawThumbnail(canvas: HTMLCanvasElement, rows: Rows, at: number): void {
  const ratio = window.devicePixelRatio || 1;
  const [width, height] = [Math.round(SIZE_px.width * ratio), Math.round(SIZE_px.height * ratio)];
  if (canvas.width !== width || canvas.height !== height) {
    canvas.width = width;
    canvas.height = height;
  }
  const context = canvas.getContext("2d") as CanvasRenderingContext2D;
  context.setTransform(ratio, 0, 0, ratio, 0, 0);
  context.clearRect(0, 0, SIZE_px.width, SIZE_px.height);
  const brush = new CanvasBrush(context);
  const { accent, grid, muted } = palette();
  const floor = SIZE_px.height - PAD_px;
  brush.line([PAD_px, SIZE_px.width - PAD_px], [floor, floor], { colour: grid });
  const strokes = (["release", "press"] as const).map(
    (stroke) => [stroke, rows.sketch_cN(at, stroke)] as const,
  );
  const most_cN = Math.max(FORCE_cN, ...strokes.flatMap(([, force]) => (force ? [Math.max(...force)] : [])));
  const travel_mm = rows.number("travel_mm", at) ?? TRAVEL_mm;
  const wide_px = (SIZE_px.width - 2 * PAD_px) * Math.min(1, travel_mm / Math.max(TRAVEL_mm, travel_mm));
  for (const [stroke, force] of strokes) {
    if (!force) continue;
    const x = Float32Array.from(force, (_, i) => PAD_px + (wide_px * i) / (SKETCH_POINTS - 1));
    const y = force.map((cN) => floor - ((SIZE_px.height - 2 * PAD_px) * cN) / most_cN);
    brush.line(x, y, stroke === "press" ? { colour: accent, width_px: 1.6 } : { colour: muted, width_px: 1 });
  }
}
