/** The button from the side: finger, cap, stop, and the places of the stroke, at the scale of the ruler. */

import { type Brush, CanvasBrush, linear, palette, type Scale, series } from "../../draw";
import type { PressFrame, PressReady } from "../../net/messages";
import { effect, force, onCleanup, shown } from "../../ui";

/** How far above the resting cap, and below the stop, there is room, mm. */
const ABOVE_mm = 3.2;
const BELOW_mm = 2.6;
const CAP = { top_ratio: 0.36, foot_ratio: 0.46, height_mm: 1.9 };
const FULL_cN = 200;
const WIDEST_px = 460;

export interface Seen {
  readonly ready: Pick<PressReady, "travel_mm" | "places">;
  readonly frame: Pick<PressFrame, "displacement_mm" | "finger_mm" | "force_cN" | "key"> | null;
  /** Where the hand leads the finger, mm; null if it does not. */
  readonly aim_mm: number | null;
  /** Neither force nor ruler may be seen. */
  readonly blind?: boolean;
}

/** Return the scale of the drawing: displacement downwards. */
export function stageScale(travel_mm: number, height_px: number): Scale {
  return linear({ low: -ABOVE_mm, high: travel_mm + BELOW_mm }, 0, height_px);
}

/** A canvas that draws what `see` gives with every frame of the screen on which something changed. */
export function stageCanvas(see: () => Seen | null, drawn: () => void): HTMLCanvasElement {
  const canvas = document.createElement("canvas");
  canvas.ariaHidden = "true";
  let asked = 0;
  const paint = () => {
    asked = 0;
    const seen = see();
    const [width, height] = fitted(canvas);
    if (width < 2 || height < 2) return;
    const context = canvas.getContext("2d") as CanvasRenderingContext2D;
    context.clearRect(0, 0, width, height);
    if (seen) drawStage(new CanvasBrush(context), seen, width, height);
    drawn();
  };
  const ask = () => {
    asked ||= requestAnimationFrame(paint);
  };
  effect(() => {
    see();
    palette();
    ask();
  });
  const observer = new ResizeObserver(ask);
  observer.observe(canvas);
  onCleanup(() => {
    observer.disconnect();
    cancelAnimationFrame(asked);
  });
  return canvas;
}

function fitted(canvas: HTMLCanvasElement): [number, number] {
  const { clientWidth: width, clientHeight: height } = canvas;
  const ratio = devicePixelRatio || 1;
  const size = [Math.round(width * ratio), Math.round(height * ratio)] as const;
  if (canvas.width !== size[0] || canvas.height !== size[1]) [canvas.width, canvas.height] = size;
  canvas.getContext("2d")?.setTransform(ratio, 0, 0, ratio, 0, 0);
  return [width, height];
}

function drawStage(brush: Brush, seen: Seen, width_px: number, height_px: number): void {
  const y = stageScale(seen.ready.travel_mm, height_px);
  const cap_mm = last(seen.frame?.displacement_mm);
  const finger_mm = seen.frame ? last(seen.frame.finger_mm) : -2;
  // a wide stage is no reason for a wide key
  const wide_px = Math.min(width_px, WIDEST_px);
  const left_px = (width_px - wide_px) / 2;
  // the ruler needs room beside the key
  const place = {
    y,
    width_px: wide_px,
    height_px,
    left_px,
    middle_px: left_px + wide_px * (seen.blind ? 0.5 : 0.4),
  };
  drawHousing(brush, place, seen.ready.travel_mm);
  drawCap(brush, place, cap_mm, (seen.frame?.key ?? 0) > 0, !seen.blind);
  drawFinger(brush, place, finger_mm, cap_mm);
  if (!seen.blind) {
    drawForce(brush, place, last(seen.frame?.force_cN), cap_mm);
    drawRuler(brush, place, seen.ready, cap_mm);
  }
  if (seen.aim_mm !== null) drawAim(brush, place, seen.aim_mm);
}

interface Place {
  readonly y: Scale;
  readonly width_px: number;
  readonly height_px: number;
  readonly left_px: number;
  readonly middle_px: number;
}

function last(column: readonly number[] | undefined): number {
  return column?.[column.length - 1] ?? 0;
}

/** The fixed part: walls, and the stop that the cap's foot meets at full travel. */
function drawHousing(brush: Brush, p: Place, travel_mm: number): void {
  const { line, raised } = { line: palette().muted, raised: palette().grid };
  const stop_px = p.y.px(travel_mm + CAP.height_mm);
  const half = (p.width_px * (CAP.foot_ratio + 0.1)) / 2;
  const wall = p.width_px * 0.035;
  const top = p.y.px(CAP.height_mm * 0.55);
  for (const left of [p.middle_px - half, p.middle_px + half - wall])
    brush.rect({ left, top, width: wall, height: stop_px - top }, { colour: raised }, { colour: line });
  brush.rect(
    { left: p.middle_px - half, top: stop_px, width: 2 * half, height: p.height_px - stop_px + 4 },
    { colour: raised },
    { colour: line },
  );
}

function drawCap(brush: Brush, p: Place, cap_mm: number, on: boolean, said: boolean): void {
  const { accent, surface, text } = palette();
  const [top, bottom] = [p.y.px(cap_mm), p.y.px(cap_mm + CAP.height_mm)];
  const [a, b] = [(p.width_px * CAP.top_ratio) / 2, (p.width_px * CAP.foot_ratio) / 2];
  const x = [-b, -a, a, b, -b].map((dx) => p.middle_px + dx);
  const sides = [bottom, top, top, bottom, bottom];
  brush.area(x, sides, { colour: surface });
  if (on) brush.area(x, sides, { colour: accent, opacity: 0.28 });
  brush.line(x, sides, { colour: on ? accent : text, width_px: on ? 2.5 : 1.5 });
  if (!said) return;
  const at = { x_px: p.middle_px, y_px: (top + bottom) / 2 };
  brush.text(on ? "ON" : "off", at, {
    colour: on ? text : palette().muted,
    align: "center",
    weight: on ? 700 : 400,
    size_px: 15,
  });
}

/** The fingertip; pulp that is squeezed lies flat on the cap. */
function drawFinger(brush: Brush, p: Place, finger_mm: number, cap_mm: number): void {
  const tip_px = p.y.px(Math.min(finger_mm, cap_mm + 0.02));
  const squeezed_px = Math.max(0, p.y.px(finger_mm) - p.y.px(cap_mm));
  const half = p.width_px * 0.105 + 0.35 * squeezed_px;
  const round = Math.max(8, p.width_px * 0.1 - squeezed_px);
  const [x, y]: [number[], number[]] = [[p.middle_px - half], [-10]];
  for (let i = 0; i <= 24; i++) {
    const angle = Math.PI * (1 - i / 24);
    x.push(p.middle_px + half * Math.cos(angle));
    y.push(tip_px - round + round * Math.sin(angle) ** 0.75);
  }
  x.push(p.middle_px + half);
  y.push(-10);
  const { colour } = series(5);
  brush.area(x, y, { colour: palette().surface });
  brush.area(x, y, { colour, opacity: 0.22 });
  brush.line(x, y, { colour, width_px: 1.5 });
}

function drawForce(brush: Brush, p: Place, force_cN: number, cap_mm: number): void {
  const { colour } = series(1);
  const full_px = p.height_px * 0.34;
  const length = Math.min(1, Math.max(0, force_cN) / FULL_cN) * full_px;
  const [x, foot] = [p.left_px + p.width_px * 0.065, p.y.px(cap_mm)];
  if (length > 2) {
    brush.line([x, x], [foot, foot - length], { colour, width_px: 4 });
    brush.line([x - 6, x, x + 6], [foot - length + 8, foot - length - 2, foot - length + 8], {
      colour,
      width_px: 3,
    });
  }
  const at = { x_px: p.left_px + 4, y_px: foot + 14 };
  brush.text(force(force_cN, 0), at, {
    colour: palette().text,
    weight: 600,
    size_px: 13,
    halo: palette().surface,
  });
}

/** Travel with its marks; the place of the cap's top beside it. */
function drawRuler(brush: Brush, p: Place, ready: Seen["ready"], cap_mm: number): void {
  const { muted, text, accent, surface, danger } = palette();
  const x = p.left_px + p.width_px * 0.76;
  brush.line([x, x], [p.y.px(0), p.y.px(ready.travel_mm)], { colour: muted, width_px: 1.5 });
  for (let mm = 0; mm <= ready.travel_mm + 1e-6; mm += 0.5) {
    const [y, long] = [p.y.px(mm), Number.isInteger(mm)];
    brush.line([x, x + (long ? 8 : 4)], [y, y], { colour: muted });
    if (long) brush.text(`${mm}`, { x_px: x - 6, y_px: y }, { colour: muted, align: "right", size_px: 11 });
  }
  brush.line([x - 4, x + 12], [p.y.px(ready.travel_mm), p.y.px(ready.travel_mm)], {
    colour: danger,
    width_px: 2,
  });
  brush.text(
    "stop",
    { x_px: x + 15, y_px: p.y.px(ready.travel_mm) + 2 },
    { colour: danger, size_px: 11, base: "top" },
  );
  for (const mark of spread(ready, p.y)) {
    const at = p.y.px(mark.place_mm);
    brush.line([x - 4, x + 12, x + 18], [at, at, mark.y_px], {
      colour: accent,
      width_px: 1.5,
      dash: mark.up ? [4, 3] : [],
    });
    brush.text(mark.label, { x_px: x + 20, y_px: mark.y_px }, { colour: text, size_px: 11, halo: surface });
  }
  const now = p.y.px(cap_mm);
  brush.area([x - 2, x - 12, x - 12], [now, now - 6, now + 6], { colour: text });
}

interface Mark {
  readonly label: string;
  readonly place_mm: number;
  readonly y_px: number;
  /** Passed on the way up. */
  readonly up: boolean;
}

/** Put labels of places that lie close together under each other; those of programs are too long to be named. */
function spread(ready: Seen["ready"], y: Scale): Mark[] {
  const plain = ready.places.filter((place) => place.label === "actuation" || place.label === "reset");
  const places = plain.length
    ? plain
    : ready.places.map((place) => ({ ...place, label: `${shown(place.place_mm, 2)} mm` }));
  const seen = new Set<string>();
  const unique = places.filter((place) => !seen.has(place.label) && seen.add(place.label));
  let [free, marks] = [-Infinity, [] as Mark[]];
  for (const place of [...unique].sort((a, b) => a.place_mm - b.place_mm)) {
    free = Math.max(free + 13, y.px(place.place_mm));
    marks.push({ ...place, y_px: free, up: place.label === "reset" });
  }
  return marks;
}

function drawAim(brush: Brush, p: Place, aim_mm: number): void {
  const { accent } = palette();
  const y = p.y.px(aim_mm);
  const half = p.width_px * 0.2;
  brush.line([p.middle_px - half, p.middle_px + half], [y, y], {
    colour: accent,
    width_px: 1.5,
    dash: [5, 4],
  });
}
