/** A key of the person's keyboard: on the curve of the button, and over time with its trigger. */

import { type Brush, Plot, palette, series, type View } from "../../draw";
import { analogKey } from "../../keyboard/analog_key";
import type { PressMeant } from "../../net/messages";
import { effect, force, shown } from "../../ui";
import { forceOf, forcesAt } from "./key_forces";
import type { OwnKey } from "./own_key";

const SHOWN_s = 3;
/** More points than a plot is wide would not be seen. */
const POINTS = 800;
/** Room for what is said beside the key. */
const LABEL_px = 150;
/** The key itself, wherever it is drawn. */
const KEY = 2;
const DOWN = 4;

/** The button's force at the speed of the key, and where the key is on it. */
export function keyForcePlot(own: OwnKey, speeds: () => readonly PressMeant[]): Plot {
  const most_cN = () => 1.2 * Math.max(60, ...speeds().flatMap((one) => [...one.press_cN]));
  const plot = new Plot({
    label: "Force of the button at the place and speed of your key",
    x: { label: "displacement of your key", unit: "mm" },
    y: { label: "force of the button", unit: "cN" },
    whole: () => ({
      x: {
        low: -0.2,
        high: Math.max(analogKey.full_scale_mm(), speeds()[0]?.displacement_mm.at(-1) ?? 4) + 0.3,
      },
      y: { low: -5, high: most_cN() },
    }),
    still: (brush, view) => drawPoints(brush, view, own),
    moving: (brush, view) => {
      drawForces(brush, view, speeds());
      own.drawn();
    },
    height_px: 240,
  });
  return plot;
}

function drawPoints(brush: Brush, view: View, own: OwnKey): void {
  const { actuation_mm, reset_mm } = own.settings();
  const { top, height } = view.box;
  const { accent } = palette();
  for (const [mm, dash] of [
    [actuation_mm, []],
    [reset_mm, [4, 3]],
  ] as const)
    brush.line([view.x.px(mm), view.x.px(mm)], [top, top + height], { colour: accent, dash, width_px: 1.5 });
}

function drawForces(brush: Brush, view: View, speeds: readonly PressMeant[]): void {
  const key = analogKey.depths.now(performance.now());
  const forces = forcesAt(speeds, key?.velocity_mm_s ?? 0);
  if (!forces) return;
  const x = forces.displacement_mm.map(view.x.px);
  const { colour } = series(0);
  brush.line(x, forces.press_cN.map(view.y.px), { colour, width_px: 2 });
  brush.line(x, forces.release_cN.map(view.y.px), { colour, width_px: 2, dash: [7, 3] });
  if (!key) return;
  const at_cN = forceOf(forces, key);
  const at = { x_px: view.x.px(key.depth_mm), y_px: view.y.px(at_cN ?? 0) };
  const { surface, text } = palette();
  brush.circle(at, 6, { colour: series(KEY).colour }, { colour: surface, width_px: 1.5 });
  const said = at_cN === null ? "beyond its stop" : force(at_cN, 0);
  const right = at.x_px > view.box.left + view.box.width - LABEL_px;
  brush.text(
    `${said} at ${shown(Math.abs(key.velocity_mm_s), 0)} mm/s`,
    { x_px: at.x_px + (right ? -10 : 10), y_px: Math.max(view.box.top + 9, at.y_px - 12) },
    { colour: text, halo: surface, weight: 600, size_px: 12, align: right ? "right" : "left" },
  );
}

/** Displacement of the key over the last seconds, with the points at which it triggers, and when it was down. */
export function keyTimePlot(own: OwnKey): Plot {
  return new Plot({
    label: "Displacement of your key over the last seconds, with its trigger",
    x: { label: "time before now", unit: "s" },
    y: { label: "displacement", unit: "mm" },
    whole: () => ({ x: { low: -SHOWN_s, high: 0 }, y: { low: -0.3, high: analogKey.full_scale_mm() + 0.3 } }),
    still: (brush, view) => drawTriggerPoints(brush, view, own),
    moving: (brush, view) => drawTravel(brush, view, own),
    height_px: 240,
  });
}

function drawTriggerPoints(brush: Brush, view: View, own: OwnKey): void {
  const { actuation_mm, reset_mm } = own.settings();
  const { accent, surface, text } = palette();
  const { left, width } = view.box;
  for (const [mm, name, dash, base] of [
    [actuation_mm, "actuation", [], "bottom"],
    [reset_mm, "reset", [4, 3], "top"],
  ] as const) {
    const y = view.y.px(mm);
    brush.line([left, left + width], [y, y], { colour: accent, dash, width_px: 1.5 });
    const at = { x_px: left + 6, y_px: y + (base === "top" ? 2 : -2) };
    brush.text(name, at, { colour: text, halo: surface, size_px: 11, base });
  }
}

function drawTravel(brush: Brush, view: View, own: OwnKey): void {
  const now_ms = performance.now();
  const x = (t_ms: number) => view.x.px((t_ms - now_ms) / 1000);
  drawDown(brush, view, own, x);
  const { t_ms, depth_mm } = analogKey.depths.since(now_ms - 1000 * SHOWN_s, POINTS);
  const last = depth_mm.at(-1);
  if (last === undefined) return;
  const { colour, dash } = series(KEY);
  brush.line([...t_ms, now_ms].map(x), [...depth_mm, last].map(view.y.px), { colour, dash, width_px: 2 });
  drawNext(brush, view, own);
}

/** When the trigger had the key down. */
function drawDown(brush: Brush, view: View, { events, state }: OwnKey, x: (t_ms: number) => number): void {
  const { top, height } = view.box;
  const fill = { colour: series(DOWN).colour, opacity: 0.25 };
  let from_ms: number | null = events[0]?.down === false ? -Infinity : null;
  const band = (until_ms: number) => {
    const left = Math.max(view.box.left, x(from_ms as number));
    const width = x(until_ms) - left;
    if (width > 0) brush.rect({ left, top, width, height }, fill);
  };
  for (const { t_ms, down } of events) {
    if (down) from_ms = t_ms;
    else if (from_ms !== null) {
      band(t_ms);
      from_ms = null;
    }
  }
  if (state.down && from_ms !== null) band(performance.now());
}

/** Where rapid trigger would change next, as it moves with the key. */
function drawNext(brush: Brush, view: View, { state, settings }: OwnKey): void {
  const { rapid, press_mm, release_mm } = settings.peek();
  if (!rapid || !state.engaged) return;
  const mm = state.turn_mm + (state.down ? -release_mm : press_mm);
  const { left, width } = view.box;
  const y = view.y.px(mm);
  const { warning, text, surface } = palette();
  brush.line([left + 0.7 * width, left + width], [y, y], { colour: warning, width_px: 2, dash: [2, 3] });
  const at = { x_px: left + 0.7 * width - 4, y_px: y };
  const said = state.down ? "lets go" : "presses";
  brush.text(said, at, { colour: text, halo: surface, size_px: 11, align: "right" });
}

/** Draw as readings come, and the time that passes without any. */
export function drawLive(own: OwnKey, ...plots: readonly Plot[]): void {
  own.onRead = () => {
    for (const plot of plots) plot.move();
  };
  effect(() => {
    if (analogKey.status() === "none") return;
    const timer = setInterval(own.onRead, 50);
    return () => clearInterval(timer);
  });
}
