/** How the error falls at one speed, both strokes, with what a person would just notice. */

import {
  type Brush,
  type PlotOptions,
  palette,
  type Range,
  RELEASE_DASH,
  rangeOf,
  type View,
  velocityColour,
} from "../../draw";
import type { CurveIntended } from "../../net";
import { watched } from "./jobs";
import { curveKey, type Stage, type StrokeName } from "./picture";

const STROKES: readonly StrokeName[] = ["press", "release"];
/** So many presses are shown at least, on the axis. */
const FEWEST = 4;

/** The speeds of the job that is looked at, slowest first. */
export function speeds(): readonly number[] {
  return [...watched().picture.intended.keys()].sort((a, b) => a - b);
}

export function errorOptions(stage: Stage, velocity_mm_s: number): PlotOptions {
  return {
    label: `Error over presses at ${velocity_mm_s} mm/s`,
    x: { label: "press", unit: "" },
    y: { label: "error", unit: "cN" },
    whole: () => ({ x: pressRange(stage, velocity_mm_s), y: errorRange(stage) }),
    still: (brush, view) => draw(brush, view, stage, velocity_mm_s),
    height_px: 190,
  };
}

function errorsOf(stage: Stage, stroke: StrokeName, velocity_mm_s: number): readonly number[] {
  return watched().picture.curves.get(curveKey(stage, stroke, velocity_mm_s))?.error_cN ?? [];
}

function pressRange(stage: Stage, velocity_mm_s: number): Range {
  const last = watched().picture.presses.findLast(
    ({ press }) => press.stage === stage && press.velocity_mm_s === velocity_mm_s,
  );
  const made = STROKES.map((stroke) => errorsOf(stage, stroke, velocity_mm_s).length);
  return { low: 0.5, high: Math.max(FEWEST, last?.press.wanted ?? 0, ...made) + 0.5 };
}

/** One range for all speeds, so that they compare by eye; it holds the line of what is noticed, and its name. */
function errorRange(stage: Stage): Range {
  const columns = [...watched().picture.curves]
    .filter(([key]) => key.startsWith(`${stage} `))
    .map(([, curve]) => curve.error_cN);
  const bounds = [...watched().picture.intended.values()].map((one) => 1.15 * noticeable_cN(one));
  return { low: 0, high: 1.05 * Math.max(5, rangeOf(columns)?.high ?? 10, ...bounds) };
}

function draw(brush: Brush, view: View, stage: Stage, velocity_mm_s: number): void {
  drawNoticeable(brush, view, velocity_mm_s);
  STROKES.forEach((stroke, i) => {
    const colour = velocityColour(velocity_mm_s);
    const dash = stroke === "release" ? RELEASE_DASH : [];
    const errors = errorsOf(stage, stroke, velocity_mm_s);
    const [at, high] = [errors.map((_, n) => view.x.px(n + 1)), errors.map((error) => view.y.px(error))];
    brush.line(at, high, { colour, dash, width_px: 2 });
    at.forEach((x_px, n) =>
      brush.circle({ x_px, y_px: high[n] as number }, 2.5, i ? null : { colour }, { colour }),
    );
  });
}

function noticeable_cN({ noticeable_press_cN, noticeable_release_cN }: CurveIntended): number {
  return Math.min(noticeable_press_cN, noticeable_release_cN);
}

function drawNoticeable(brush: Brush, view: View, velocity_mm_s: number): void {
  const found = watched().picture.intended.get(velocity_mm_s);
  if (!found) return;
  const { muted, surface } = palette();
  const { left, width } = view.box;
  const bound_cN = noticeable_cN(found);
  const y = view.y.px(bound_cN);
  brush.line([left, left + width], [y, y], { colour: muted, dash: [2, 3] });
  const style = { colour: muted, align: "right", base: "bottom", size_px: 10, halo: surface } as const;
  brush.text(`noticed ${bound_cN.toFixed(1)}`, { x_px: left + width - 3, y_px: y - 3 }, style);
}
