/** Pictures of how a run goes: scores with their errors and the best so far, and every press, small. */

import { type Brush, CanvasBrush, Plot, palette, rangeOf, series, type View } from "../../draw";
import type { OptimizeTrial } from "../../net/messages";
import { curveLine, named, type RunStore } from "./store";

const SIZE_px = { width: 72, height: 34 } as const;

/** Score over trial, one standard error either way, and the least so far. */
export function scoreChart(store: RunStore): Plot {
  const { label, unit } = named("asynchrony_ms");
  return new Plot({
    label: "Score of every trial with its standard error, and the best so far",
    x: { label: "trial", unit: "" },
    y: { label, unit },
    whole: () => {
      const all = values(store);
      const y = rangeOf(
        [all.map((one) => one.value + one.error), all.map((one) => one.value - one.error)],
        0.1,
      ) ?? { low: 0, high: 1 };
      return {
        x: { low: 0, high: Math.max(8, (store.detail()?.row.budget ?? 8) + 0.5) },
        y: { low: Math.max(0, y.low), high: y.high },
      };
    },
    still: (brush, view) => drawScores(brush, view, store),
    height_px: 210,
  });
}

function values(
  store: RunStore,
): { readonly at: number; readonly value: number; readonly error: number; readonly number: number }[] {
  const name = store.objective();
  return store.done().flatMap((trial) => {
    const score = trial.scores[name];
    return score
      ? [{ at: trial.number + 1, value: score.value, error: score.error ?? 0, number: trial.number }]
      : [];
  });
}

function drawScores(brush: Brush, view: View, store: RunStore): void {
  const all = values(store);
  const [one, two] = [series(0), series(1)];
  let least = Infinity;
  const best = all.flatMap(({ at, value }) => {
    const before = least;
    least = Math.min(least, value);
    return Number.isFinite(before)
      ? [
          [at, before],
          [at, least],
        ]
      : [[at, least]];
  });
  brush.line(
    best.map(([at]) => view.x.px(at as number)),
    best.map(([, y]) => view.y.px(y as number)),
    { colour: two.colour, dash: two.dash, width_px: 2 },
  );
  for (const { at, value, error, number } of all) {
    const x = view.x.px(at);
    brush.line([x, x], [view.y.px(value - error), view.y.px(value + error)], {
      colour: one.colour,
      width_px: 1.5,
    });
    const chosen = store.chosen() === number;
    brush.circle(
      { x_px: x, y_px: view.y.px(value) },
      chosen ? 6 : 4,
      { colour: one.colour },
      { colour: palette().surface, width_px: 1.5 },
    );
  }
}

/** Draw the press of a design, small; all on the same axes. */
export function drawSketch(canvas: HTMLCanvasElement, { curve }: OptimizeTrial): void {
  const ratio = devicePixelRatio || 1;
  [canvas.width, canvas.height] = [SIZE_px.width * ratio, SIZE_px.height * ratio];
  const context = canvas.getContext("2d");
  if (!context) return;
  context.setTransform(ratio, 0, 0, ratio, 0, 0);
  const { x_mm, y_cN } = curveLine(curve);
  const brush = new CanvasBrush(context);
  const x = (mm: number) => 2 + (mm / Math.max(6.2, x_mm.at(-1) ?? 0)) * (SIZE_px.width - 4);
  const y = (cN: number) => SIZE_px.height - 2 - (cN / Math.max(320, ...y_cN)) * (SIZE_px.height - 4);
  brush.line(x_mm.map(x), y_cN.map(y), { colour: palette().accent, width_px: 1.6 });
  const at = curve.actuation_mm;
  if (at !== null)
    brush.line([x(at), x(at)], [2, SIZE_px.height - 2], { colour: palette().muted, dash: [2, 2] });
}
