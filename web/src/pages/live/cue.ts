/** The moving cue: a dot that moves as the cap should, on its path over time; counted in, with beeps. */

import { type Brush, Plot, palette, series, type View } from "../../draw";
import { type Child, effect, h, onCleanup, signal, toggle, untracked } from "../../ui";
import { countIn, depthAt } from "./motion";
import { BEEP_Hz, beep } from "./sound";

export interface Cue {
  readonly travel_mm: number;
  readonly contact_s: number;
  readonly stroke_s: number;
  readonly length_s: number;
}

const KEY = "fdvv-beeps";
export const beeps = signal(localStorage.getItem(KEY) !== "off");

export function beepToggle(): HTMLElement {
  const set = (on: boolean) => {
    beeps.set(on);
    localStorage.setItem(KEY, on ? "on" : "off");
  };
  return toggle({ label: "Beep at contact and bottom", value: () => beeps(), set });
}

/** Show a cue. It begins each time that `begun` changes; at once where that is null. */
export function cueView(cue: Cue, begun: (() => number) | null): Child {
  const since_ms = signal<number | null>(null);
  const count = signal("");
  const plot = cuePlot(cue, () => since_ms.peek());
  let frame = 0;
  const step = () => {
    const t_s = elapsed(since_ms.peek());
    count.set(countIn(t_s, cue.contact_s));
    plot.move();
    if (t_s < cue.length_s) frame = requestAnimationFrame(step);
    else since_ms.set(null);
  };
  const begin = () => {
    since_ms.set(performance.now());
    if (untracked(() => beeps())) schedule(cue);
    cancelAnimationFrame(frame);
    frame = requestAnimationFrame(step);
  };
  followCount(begun, begin);
  onCleanup(() => cancelAnimationFrame(frame));
  return h(
    "div",
    { class: "cue" },
    plot.element,
    h("div", { class: "cue-count", role: "timer", "aria-live": "off" }, () => count()),
  );
}

function followCount(begun: (() => number) | null, begin: () => void): void {
  if (!begun) return begin();
  let seen = untracked(begun);
  effect(() => {
    const now = begun();
    if (now !== seen) begin();
    seen = now;
  });
}

function elapsed(since_ms: number | null): number {
  return since_ms === null ? 0 : (performance.now() - since_ms) / 1000;
}

function schedule(cue: Cue): void {
  beep(BEEP_Hz.contact, cue.contact_s);
  beep(BEEP_Hz.bottom, cue.contact_s + cue.stroke_s);
}

/** The path comes towards a dot that stays in place and only goes up and down, as the cap should. */
function cuePlot(cue: Cue, since_ms: () => number | null): Plot {
  const height_mm = (t_s: number) => -cue.travel_mm * depthAt(t_s - cue.contact_s, cue.stroke_s);
  const wide_s = Math.min(6, Math.max(0.8, 6 * cue.stroke_s));
  return new Plot({
    label: "The cue to follow: height of the cap over time",
    x: { label: "time from now", unit: "s" },
    y: { label: "height of the cap", unit: "mm" },
    whole: () => ({
      x: { low: -0.25 * wide_s, high: 0.75 * wide_s },
      y: { low: -1.15 * cue.travel_mm, high: 0.15 * cue.travel_mm },
    }),
    moving: (brush, view) => drawPath(brush, view, cue, elapsed(since_ms()), height_mm),
    height_px: 240,
  });
}

function drawPath(
  brush: Brush,
  view: View,
  cue: Cue,
  now_s: number,
  height_mm: (t_s: number) => number,
): void {
  const count = Math.round(view.box.width / 2);
  const { low, high } = view.x.range;
  const ahead = Array.from({ length: count }, (_, i) => low + ((high - low) * i) / (count - 1));
  const { colour } = series(0);
  brush.line(
    ahead.map((t) => view.x.px(t)),
    ahead.map((t) => view.y.px(height_mm(now_s + t))),
    { colour, width_px: 3, opacity: 0.55 },
  );
  drawMoments(brush, view, cue, now_s);
  const at = { x_px: view.x.px(0), y_px: view.y.px(height_mm(now_s)) };
  brush.circle(at, 11, { colour: palette().accent }, { colour: palette().surface, width_px: 2 });
}

function drawMoments(brush: Brush, view: View, cue: Cue, now_s: number): void {
  const { muted, surface } = palette();
  const { top, height } = view.box;
  for (const [t_s, name, y_px] of [
    [cue.contact_s, "contact", top + 8],
    [cue.contact_s + cue.stroke_s, "bottom", top + height - 10],
  ] as const) {
    const x = view.x.px(t_s - now_s);
    brush.line([x, x], [top, top + height], { colour: muted, dash: [3, 3] });
    brush.text(name, { x_px: x + 4, y_px }, { colour: muted, size_px: 11, halo: surface });
  }
}
