/** The rendered force: over displacement beside the target, and over time. */

import { type Brush, Plot, palette, type Range, series, type View } from "../../draw";
import { effect } from "../../ui";
import type { PressSession } from "./session";

/** How much of the past is drawn over displacement, and over time. */
const TRAIL_s = 2.5;
const SHOWN_s = 4;
/** Slower for people who want less motion. */
const CALM_s = 0.25;

function calm(): boolean {
  return matchMedia("(prefers-reduced-motion: reduce)").matches;
}

/** Force over displacement: the target of slow presses, and the trail of the rendered force. */
export function forcePlot(session: PressSession): Plot {
  const plot = new Plot({
    label: "Rendered force over displacement, beside the target force",
    x: { label: "displacement", unit: "mm" },
    y: { label: "force, simulated", unit: "cN" },
    whole: () => {
      const { least_cN, most_cN } = extent(session);
      return {
        x: { low: -0.3, high: (session.ready()?.travel_mm ?? 4) + 0.4 },
        y: { low: least_cN - 5, high: most_cN },
      };
    },
    still: (brush, view) => drawMeant(brush, view, session),
    moving: (brush, view) => drawTrail(brush, view, session),
  });
  effect(() => {
    session.frame();
    plot.move();
  });
  return plot;
}

/** The forces that axes are made for: those of a slow press, with room for what a finger adds at the stop. */
function extent(session: PressSession): { readonly least_cN: number; readonly most_cN: number } {
  const target = session.ready()?.meant;
  const all = [...(target?.press_cN ?? []), ...(target?.release_cN ?? [])];
  return { least_cN: Math.min(0, ...all), most_cN: 1.5 * Math.max(60, ...all) };
}

function drawMeant(brush: Brush, view: View, session: PressSession): void {
  const [ready, target] = [session.ready(), session.target()];
  if (!ready || !target) return;
  const x = target.displacement_mm.map(view.x.px);
  const { colour } = series(0);
  brush.line(x, target.press_cN.map(view.y.px), { colour, width_px: 2 });
  brush.line(x, target.release_cN.map(view.y.px), { colour, width_px: 2, dash: [7, 3] });
  const stop = view.x.px(ready.travel_mm);
  const { top, height } = view.box;
  brush.line([stop, stop], [top, top + height], { colour: palette().danger, dash: [2, 3] });
  for (const place of ready.places) {
    const at = view.x.px(place.place_mm);
    brush.line([at, at], [top + height - 10, top + height], { colour: palette().accent, width_px: 2 });
  }
}

function drawTrail(brush: Brush, view: View, session: PressSession): void {
  const { colour } = series(1);
  const now_s = session.rows.now_s();
  const old = session.rows.since(now_s - TRAIL_s);
  const line = (rows: typeof old, opacity: number, width_px: number) =>
    brush.line(rows.displacement_mm.map(view.x.px), rows.force_cN.map(view.y.px), {
      colour,
      width_px,
      opacity,
    });
  line(old, 0.4, 1.25);
  line(session.rows.since(now_s - 0.25), 1, 2.25);
  const here = session.rows.since(now_s);
  const [x, y] = [here.displacement_mm.at(-1), here.force_cN.at(-1)];
  if (x === undefined || y === undefined) return;
  brush.circle(
    { x_px: view.x.px(x), y_px: view.y.px(y) },
    5,
    { colour },
    { colour: palette().surface, width_px: 1.5 },
  );
}

type Column = "force_cN" | "displacement_mm";

/** Force and displacement over the last seconds. */
export function timePlots(session: PressSession): readonly Plot[] {
  const travel_mm = () => session.ready()?.travel_mm ?? 4;
  const force_cN = () => ({ low: -5, high: extent(session).most_cN });
  const plots = [
    timePlot(session, "force_cN", { label: "force", unit: "cN" }, force_cN, 92),
    timePlot(
      session,
      "displacement_mm",
      { label: "displacement", unit: "mm" },
      () => ({ low: -0.3, high: travel_mm() + 0.6 }),
      84,
    ),
  ];
  let drawn_s = 0;
  effect(() => {
    session.frame();
    const now_s = session.rows.now_s();
    if (calm() && now_s - drawn_s < CALM_s && now_s > drawn_s) return;
    drawn_s = now_s;
    for (const plot of plots) plot.move();
  });
  return plots;
}

function timePlot(
  session: PressSession,
  which: Column,
  y: { label: string; unit: string },
  range: () => Range,
  height_px: number,
): Plot {
  const { colour, dash } = series(which === "force_cN" ? 1 : 2);
  return new Plot({
    label: `${y.label[0]?.toUpperCase()}${y.label.slice(1)} over the last seconds, simulated`,
    x: { label: "time before now", unit: "s" },
    y,
    whole: () => ({ x: { low: -SHOWN_s, high: 0 }, y: range() }),
    still: (brush, { box }) =>
      brush.text(
        `${y.label}, ${y.unit}`,
        { x_px: box.left + 6, y_px: box.top + 7 },
        { colour: palette().muted, size_px: 11, halo: palette().surface },
      ),
    moving: (brush, view) => {
      const rows = session.rows.since(session.rows.now_s() - SHOWN_s, 4);
      const now_s = session.rows.now_s();
      const x = rows.t_s.map((t) => view.x.px(t - now_s));
      brush.line(x, rows[which].map(view.y.px), { colour, dash, width_px: 1.5 });
    },
    height_px,
    small: true,
  });
}
