/** The design that was found beside the one it began with: models, curves, numbers. */

import { type Brush, Plot, palette, RELEASE_DASH, series, type View } from "../../draw";
import {
  type ButtonLike,
  force_cN,
  type Landmarks,
  landmarks,
  linspace,
  ModelError,
  nearest,
} from "../../math";
import type { FDVVModel } from "../../model";
import { call } from "../../net";
import type { OptimizeDetail } from "../../net/messages";
import { digitsOf, perUnit, shown } from "../../ui";
import { type Design, headed, named } from "./store";

export const SIDES = ["start", "found"] as const;
export type Side = (typeof SIDES)[number];
export type Models = Readonly<Record<Side, FDVVModel>>;
/** A number of both designs and how they differ, written. */
export type Row = readonly [name: string, start: string, found: string, off: string];

const ROWS: readonly (keyof Landmarks)[] = [
  "preload_cN",
  "peak_mm",
  "peak_cN",
  "valley_mm",
  "valley_cN",
  "actuation_mm",
  "actuation_cN",
  "bottom_out_cN",
  "work_mJ",
];
const POINTS = 240;
/** Enough for the stiffest design of the paper's space, 310 cN at any place. */
export const STIFFEST_PUSH_cN = 350;

export async function fetched(run: number, start: Design, found: Design): Promise<Models> {
  const model = async (design: Design, name: string) =>
    (await call("optimize.model", { run, design, name })).model as unknown as FDVVModel;
  const [one, two] = await Promise.all([model(start, "start"), model(found, "found")]);
  return { start: one, found: two };
}

export function overlay(models: Models): Plot {
  const travel = Math.max(models.start.travel_mm, models.found.travel_mm);
  const lines = SIDES.flatMap((side, n) =>
    (["press", "release"] as const).map((stroke) => ({ n, stroke, side, ...line(models[side], stroke) })),
  );
  const most = Math.max(...lines.flatMap((line) => [...line.y_cN].filter(Number.isFinite)));
  const paint = (brush: Brush, view: View) => {
    for (const { n, stroke, x_mm, y_cN } of lines)
      brush.line(x_mm.map(view.x.px), y_cN.map(view.y.px), {
        colour: series(n).colour,
        dash: stroke === "press" ? [] : RELEASE_DASH,
        width_px: stroke === "press" ? 2 : 1.25,
      });
    SIDES.forEach((side, n) => {
      const at = models[side].actuation_mm;
      if (at === null) return;
      const x = view.x.px(at);
      brush.line([x, x], [view.box.top + view.box.height - 14, view.box.top + view.box.height], {
        colour: series(n).colour,
        width_px: 3,
      });
      brush.text(
        n ? "▲" : "△",
        { x_px: x, y_px: view.box.top + view.box.height - 20 },
        { colour: series(n).colour, align: "center", halo: palette().surface },
      );
    });
  };
  return new Plot({
    label: "Force over displacement of the best design and the start",
    x: { label: "displacement", unit: "mm" },
    y: { label: "force", unit: "cN" },
    whole: () => ({ x: { low: -0.05, high: travel * 1.02 }, y: { low: 0, high: most * 1.1 } }),
    still: paint,
    height_px: 260,
  });
}

function line(model: ButtonLike, stroke: "press" | "release"): { x_mm: Float64Array; y_cN: Float64Array } {
  const x_mm = linspace(0, model.travel_mm, POINTS);
  const curve = nearest(model, stroke);
  return { x_mm, y_cN: curve ? force_cN(curve, x_mm) : new Float64Array(POINTS).fill(NaN) };
}

/** Write the parameters and landmarks of both designs; scores of single trials say less than the retest. */
export function numbers(detail: OptimizeDetail, models: Models, found: Design): Row[] {
  const { start, parameters } = detail;
  const [before, after] = [marksOf(models.start), marksOf(models.found)];
  return [
    ...parameters.map(({ name }) => row(name, start?.[name], found[name])),
    ...ROWS.filter((name) => !parameters.some((one) => one.name === name)).map((name) =>
      row(name, before?.[name], after?.[name]),
    ),
  ];
}

function row(name: string, start?: number | null, found?: number | null): Row {
  const { unit } = named(name);
  const inShown = (value: number) => shown(value * perUnit(unit), digitsOf(unit, 2));
  const text = (value?: number | null) => (value == null ? "–" : inShown(value));
  const off = start == null || found == null ? "" : inShown(found - start);
  return [headed(name), text(start), text(found), off];
}

function marksOf(model: ButtonLike): Landmarks | null {
  try {
    return landmarks(model);
  } catch (error) {
    if (error instanceof ModelError) return null;
    throw error;
  }
}
