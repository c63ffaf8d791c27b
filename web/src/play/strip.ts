/** The strip of lights on the screen: a row of pixels, the zone, the bullet. */

import { type Brush, CanvasBrush, palette } from "../draw";
import { effect, h, onCleanup } from "../ui";
import type { Strip } from "./game";

const GAP_ratio = 0.28;
const ZONE_opacity = 0.45;
const DARK_opacity = 0.22;

export interface StripView {
  readonly element: HTMLElement;
  /** Draw now, in this frame: the pixel that is lit, or none. */
  draw(lit_px: number | null): void;
}

/** Make the strip; the still layer is drawn when its size, theme or game changes, the bullet by draw(). */
export function stripView(strip: () => Strip): StripView {
  const [still, moving] = [h("canvas", { "aria-hidden": "true" }), h("canvas", { "aria-hidden": "true" })];
  const label = "A strip of lights: a bullet flies from the left to the marked zone";
  const element = h("div", { class: "strip", role: "img", "aria-label": label }, still, moving);
  let last: number | null = null;
  const draw = (lit_px: number | null) => {
    last = lit_px;
    painted(
      moving,
      (brush, width, height) => lit_px !== null && bullet(brush, strip(), lit_px, width, height),
    );
  };
  const paint = () => {
    painted(still, (brush, width, height) => row(brush, strip(), width, height));
    draw(last);
  };
  effect(() => {
    strip();
    palette();
    paint();
  });
  const observer = new ResizeObserver(paint);
  observer.observe(element);
  onCleanup(() => observer.disconnect());
  return { element, draw };
}

function painted(
  canvas: HTMLCanvasElement,
  work: (brush: Brush, width_px: number, height_px: number) => void,
): void {
  const { clientWidth: width, clientHeight: height } = canvas;
  const context = canvas.getContext("2d");
  if (!context || width < 2 || height < 2) return;
  const ratio = devicePixelRatio || 1;
  const size = [Math.round(width * ratio), Math.round(height * ratio)] as const;
  if (canvas.width !== size[0] || canvas.height !== size[1]) [canvas.width, canvas.height] = size;
  context.setTransform(ratio, 0, 0, ratio, 0, 0);
  context.clearRect(0, 0, width, height);
  work(new CanvasBrush(context), width, height);
}

/** Return the box of a pixel. */
function box(strip: Strip, at: number, width_px: number, height_px: number) {
  const pitch = width_px / strip.pixels;
  const side = pitch * (1 - GAP_ratio);
  const tall = Math.min(height_px * 0.6, side * 2.2);
  return { left: at * pitch + (pitch - side) / 2, top: (height_px - tall) / 2, width: side, height: tall };
}

function row(brush: Brush, strip: Strip, width_px: number, height_px: number): void {
  const { muted, good } = palette();
  const pitch = width_px / strip.pixels;
  const { zone_px, zone_half_px } = strip;
  for (let at = 0; at < strip.pixels; at++) {
    const zone = Math.abs(at - zone_px) <= zone_half_px;
    brush.rect(
      box(strip, at, width_px, height_px),
      zone ? { colour: good, opacity: ZONE_opacity } : { colour: muted, opacity: DARK_opacity },
    );
  }
  const x = (zone_px + 0.5) * pitch;
  // the zone is marked by shape too, above and below its middle
  for (const [from, to] of [
    [0, 0.16],
    [0.84, 1],
  ] as const)
    brush.line([x, x], [from * height_px, to * height_px], { colour: good, width_px: 3 });
}

function bullet(brush: Brush, strip: Strip, at: number, width_px: number, height_px: number): void {
  const { left, top, width, height } = box(strip, at, width_px, height_px);
  const colour = palette().accent;
  brush.rect(
    { left: left - width, top: top - width, width: 3 * width, height: height + 2 * width },
    { colour, opacity: 0.25 },
  );
  brush.rect({ left: left - 1, top: top - 1, width: width + 2, height: height + 2 }, { colour });
}
