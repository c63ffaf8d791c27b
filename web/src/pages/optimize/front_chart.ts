/** The front of a run of several objectives: one more wish over the first, as measured, and expected values. */

import { type Brush, Plot, palette, rangeOf, series, type View } from "../../draw";
import type { OptimizeScore, OptimizeTrial } from "../../net/messages";
import { named, type RunStore } from "./store";

type At = readonly [x: OptimizeScore, y: OptimizeScore];

/** Trials as measured, and the front's expected values with their standard errors. */
export function frontChart(store: RunStore, other: string): Plot {
  const first = store.objective();
  const { label } = named(other);
  return new Plot({
    label: `${label} over ${named(first).label}: trials as measured, and the front's expected values`,
    x: named(first),
    y: named(other),
    whole: () => {
      const seen = [...points(store, first, other), ...front(store, first, other).map(({ at }) => at)];
      return { x: range(seen.map(([x]) => x)), y: range(seen.map(([, y]) => y)) };
    },
    still: (brush, view) => draw(brush, view, store, first, other),
    height_px: 260,
  });
}

function range(scores: readonly OptimizeScore[]) {
  const ends = scores.map(({ value }) => value);
  return rangeOf([ends], 0.1) ?? { low: 0, high: 1 };
}

function pair(scores: OptimizeTrial["scores"], first: string, other: string): At[] {
  const [x, y] = [scores[first], scores[other]];
  return x && y ? [[x, y]] : [];
}

function points(store: RunStore, first: string, other: string): At[] {
  return store.done().flatMap(({ scores }) => pair(scores, first, other));
}

function front(
  store: RunStore,
  first: string,
  other: string,
): { readonly number: number; readonly at: At }[] {
  return store
    .done()
    .flatMap(({ number, expected }) => pair(expected, first, other).map((at) => ({ number, at })));
}

function draw(brush: Brush, view: View, store: RunStore, first: string, other: string): void {
  const [one, two] = [series(0), series(1)];
  for (const [x, y] of points(store, first, other))
    brush.circle(
      { x_px: view.x.px(x.value), y_px: view.y.px(y.value) },
      3,
      { colour: palette().muted },
      { colour: palette().surface, width_px: 1 },
    );
  for (const { number, at } of front(store, first, other)) {
    const [x, y] = at;
    const [x_px, y_px] = [view.x.px(x.value), view.y.px(y.value)];
    const stroke = { colour: one.colour, width_px: 1.5 };
    const [dx, dy] = [x.error ?? 0, y.error ?? 0];
    brush.line([view.x.px(x.value - dx), view.x.px(x.value + dx)], [y_px, y_px], stroke);
    brush.line([x_px, x_px], [view.y.px(y.value - dy), view.y.px(y.value + dy)], stroke);
    const taken = store.detail()?.compromise === number;
    brush.circle(
      { x_px, y_px },
      taken ? 7 : 4.5,
      { colour: taken ? two.colour : one.colour },
      { colour: palette().surface, width_px: 1.5 },
    );
  }
}
