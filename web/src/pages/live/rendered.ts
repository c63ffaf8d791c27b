/** Before and after: target and rendered forces of both strokes at one speed, and where a finger would notice. */

import {
  type Brush,
  type PlotOptions,
  palette,
  type Range,
  RELEASE_DASH,
  rangeOf,
  series,
  type View,
} from "../../draw";
import type { CurveIntended, CurveNoticed, FeltCurve } from "../../net";
import type { JobPicture, Stage } from "./picture";
import { spans } from "./spans";

type Stroke = "press" | "release";
const STROKES: readonly Stroke[] = ["press", "release"];

/** picture : that of now. */
export function renderedOptions(picture: () => JobPicture, velocity_mm_s: number): PlotOptions {
  return {
    label: `Force over displacement at ${velocity_mm_s} mm/s: target, before and after`,
    x: { label: "displacement", unit: "mm" },
    y: { label: "force", unit: "cN" },
    whole: () => whole(picture()),
    still: (brush, view) => draw(brush, view, picture(), velocity_mm_s),
    zoom: true,
    height_px: 220,
  };
}

/** The last press of a stage at a speed. */
function last(picture: JobPicture, velocity_mm_s: number, stage: Stage): FeltCurve | undefined {
  const found = picture.presses.findLast(
    ({ press }) =>
      press.velocity_mm_s === velocity_mm_s && press.felt && !press.skipped && press.stage === stage,
  );
  return found?.press.felt ?? undefined;
}

/** Held-out presses say it better than those that were learned from. */
const after = (picture: JobPicture, velocity_mm_s: number) =>
  last(picture, velocity_mm_s, "probe") ?? last(picture, velocity_mm_s, "compensate");

/** One range for all speeds, so that they compare by eye; it holds all that is drawn. */
function whole(picture: JobPicture): { x: Range; y: Range } {
  const intended = [...picture.intended.values()];
  const felt = intended.flatMap(({ velocity_mm_s: v }) => [last(picture, v, "baseline"), after(picture, v)]);
  const columns = [...intended, ...felt].flatMap((one) =>
    one ? STROKES.map((stroke) => one[`${stroke}_cN`].map((cN) => cN ?? NaN)) : [],
  );
  const x_mm = intended[0]?.displacement_mm ?? [0, 4];
  const y = rangeOf(columns, 0.08) ?? { low: 0, high: 100 };
  return { x: { low: 0, high: x_mm.at(-1) as number }, y: { low: Math.min(0, y.low), high: y.high } };
}

function draw(brush: Brush, view: View, picture: JobPicture, velocity_mm_s: number): void {
  const wanted = picture.intended.get(velocity_mm_s);
  if (!wanted) return;
  const x = wanted.displacement_mm.map((mm) => view.x.px(mm));
  const { text } = palette();
  const lines = (
    curve: Pick<FeltCurve, "press_cN" | "release_cN"> | undefined,
    colour: string,
    width_px: number,
  ) => {
    for (const stroke of curve ? STROKES : []) {
      const y = curve?.[`${stroke}_cN`].map((cN) => (cN === null ? NaN : view.y.px(cN))) ?? [];
      brush.line(x, y, { colour, width_px, ...(stroke === "release" && { dash: RELEASE_DASH }) });
    }
  };
  for (const stroke of STROKES) band(brush, view, x, wanted, stroke);
  const felt = after(picture, velocity_mm_s);
  if (felt) for (const curve of noticed(picture, velocity_mm_s)) mark(brush, view, wanted, felt, curve);
  lines(last(picture, velocity_mm_s, "baseline"), series(0).colour, 1.5);
  lines(wanted, text, 1.2);
  lines(felt, series(1).colour, 2);
}

/** One just noticeable difference on either side of a target; nothing for jobs of older versions. */
function band(brush: Brush, view: View, x: readonly number[], wanted: CurveIntended, stroke: Stroke): void {
  const [force_cN, jnd_cN] = [wanted[`${stroke}_cN`], wanted[`${stroke}_jnd_cN`] ?? []];
  if (jnd_cN.length !== force_cN.length) return;
  const edge = (sign: number) => force_cN.map((cN, i) => view.y.px(cN + sign * (jnd_cN[i] as number)));
  brush.area([...x, ...[...x].reverse()], [...edge(-1), ...edge(1).reverse()], {
    colour: palette().muted,
    opacity: 0.18,
  });
}

function noticed(picture: JobPicture, velocity_mm_s: number): readonly CurveNoticed[] {
  const found = picture.outcomes.find((one) => one.stage === "probe")?.noticed ?? [];
  return found.filter((one) => one.velocity_mm_s === velocity_mm_s);
}

/** Fill what is between target and rendered where most held-out presses would be noticed, and say so with a bar. */
function mark(brush: Brush, view: View, wanted: CurveIntended, felt: FeltCurve, curve: CurveNoticed): void {
  const { warning } = palette();
  const [asked_cN, rendered_cN] = [wanted[`${curve.stroke}_cN`], felt[`${curve.stroke}_cN`]];
  const y = view.box.top + view.box.height - (curve.stroke === "press" ? 9 : 3);
  for (const [from, to] of spans(curve.displacement_mm, curve.noticed_ratio)) {
    const at = wanted.displacement_mm.flatMap((mm, i) =>
      mm >= from && mm <= to && rendered_cN[i] != null ? [i] : [],
    );
    const x = at.map((i) => view.x.px(wanted.displacement_mm[i] as number));
    const edge = (cN: readonly (number | null)[]) => at.map((i) => view.y.px(cN[i] as number));
    brush.area([...x, ...[...x].reverse()], [...edge(asked_cN), ...edge(rendered_cN).reverse()], {
      colour: warning,
      opacity: 0.45,
    });
    brush.line([view.x.px(from), view.x.px(to)], [y, y], { colour: warning, width_px: 4 });
  }
}
