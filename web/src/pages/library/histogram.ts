/** How the buttons spread over a figure, as bars. */

import { palette } from "../../draw";
import type { LibraryHistogram } from "../../net/messages";
import type { RangeAsked } from "./state";

const SIZE_px = { width: 180, height: 30 } as const;

/** Return the end of the bin that an event is nearest to. */
export function valueAt(canvas: HTMLCanvasElement, found: LibraryHistogram, event: PointerEvent): number {
  const frame = canvas.getBoundingClientRect();
  const part = Math.min(1, Math.max(0, (event.clientX - frame.left) / frame.width));
  const bin = Math.round(part * found.counts.length) / found.counts.length;
  return Number((found.lowest + bin * (found.highest - found.lowest)).toPrecision(3));
}

export function drawHistogram(
  canvas: HTMLCanvasElement,
  found: LibraryHistogram | undefined,
  range: RangeAsked,
): void {
  const ratio = window.devicePixelRatio || 1;
  canvas.width = SIZE_px.width * ratio;
  canvas.height = SIZE_px.height * ratio;
  const context = canvas.getContext("2d") as CanvasRenderingContext2D;
  context.setTransform(ratio, 0, 0, ratio, 0, 0);
  const { accent, line, muted } = { ...palette(), line: palette().grid };
  context.fillStyle = line;
  context.fillRect(0, SIZE_px.height - 1, SIZE_px.width, 1);
  if (!found) return;
  const most = Math.max(1, ...found.counts);
  const wide = SIZE_px.width / found.counts.length;
  found.counts.forEach((count, i) => {
    const middle = found.lowest + ((i + 0.5) / found.counts.length) * (found.highest - found.lowest);
    const inside =
      (range.low === null || middle >= range.low) && (range.high === null || middle <= range.high);
    // few must be seen beside many
    const tall = count ? Math.max(2, (SIZE_px.height - 2) * Math.sqrt(count / most)) : 0;
    context.fillStyle = inside ? accent : muted;
    context.globalAlpha = inside ? 0.85 : 0.3;
    context.fillRect(i * wide, SIZE_px.height - 1 - tall, wide - 1, tall);
  });
  context.globalAlpha = 1;
}
