/** Drawing the forces of a state: curves per velocity, where it leads on, where it vibrates, what was found. */

import { type Brush, palette, RELEASE_DASH, series, type View, velocityColour } from "../../draw";
import type { ProgramFinding } from "../../net/messages";
import { positionOf_mm, shortly } from "../../programs/condition";
import {
  type ProgramDocument,
  type State,
  type Stroke,
  type Surface,
  transitionsOf,
} from "../../programs/document";
import { vibrationsIn } from "../../programs/edits_parts";
import { forceAt_cN } from "../../programs/surface";
import { force, shown } from "../../ui";
import { handlesOf } from "./forces_points";

/** What there is to draw of a state. */
export interface ForcePicture {
  readonly document: ProgramDocument;
  readonly state: State;
  readonly stroke: Stroke;
  readonly row: number;
  readonly press: Surface | null;
  readonly release: Surface | null;
  readonly findings: readonly ProgramFinding[];
}

const CELLS = { x: 90, y: 28 } as const;

/** Draw every row of both strokes, the edited one strong, and the displacements that mean something. */
export function drawCurves(brush: Brush, view: View, picture: ForcePicture): void {
  drawZero(brush, view);
  drawTravel(brush, view, picture);
  for (const stroke of ["release", "press"] as const) drawStroke(brush, view, picture, stroke);
  drawWays(brush, view, picture);
  drawVibrations(brush, view, picture);
  drawFindings(brush, view, picture);
}

function drawZero(brush: Brush, view: View): void {
  const y = view.y.px(0);
  brush.line([view.box.left, view.box.left + view.box.width], [y, y], {
    colour: palette().muted,
    opacity: 0.6,
  });
}

function drawTravel(brush: Brush, view: View, { document }: ForcePicture): void {
  const left = view.x.px(document.travel_mm);
  const width = view.box.left + view.box.width - left;
  if (width <= 0) return;
  brush.rect(
    { left, top: view.box.top, width, height: view.box.height },
    { colour: palette().muted, opacity: 0.16 },
  );
}

function drawStroke(brush: Brush, view: View, picture: ForcePicture, stroke: Stroke): void {
  const surface = picture[stroke];
  if (!surface) return;
  surface.force_cN.forEach((row, i) => {
    const edited = stroke === picture.stroke && i === picture.row;
    const colour = velocityColour(surface.velocity_mm_s[i]!);
    const places = [view.x.range.low, ...surface.displacement_mm, view.x.range.high];
    const forces = [row[0]!, ...row, row[row.length - 1]!];
    brush.line(
      places.map((x_mm) => view.x.px(x_mm)),
      forces.map((cN) => view.y.px(cN)),
      {
        colour,
        width_px: edited ? 2.5 : 1.4,
        opacity: edited ? 1 : 0.75,
        ...(stroke === "release" ? { dash: RELEASE_DASH } : {}),
      },
    );
    label(brush, view, surface, stroke, i, colour);
  });
}

/** Name a curve on itself, at a place of its own, so that colour is not all that tells them apart. */
function label(
  brush: Brush,
  view: View,
  surface: Surface,
  stroke: Stroke,
  row: number,
  colour: string,
): void {
  const count = surface.velocity_mm_s.length;
  const ratio = (stroke === "press" ? 0.3 : 0.55) + (0.3 * row) / Math.max(1, count);
  const x_mm = view.x.range.low + ratio * (view.x.range.high - view.x.range.low);
  const speed = surface.velocity_mm_s[row]!;
  const words = count > 1 ? `${stroke} ${shown(speed)} mm/s` : stroke;
  const up = stroke === "press" ? -9 : 10;
  const at = { x_px: view.x.px(x_mm), y_px: view.y.px(forceAt_cN(surface, x_mm, speed)) + up };
  brush.text(words, at, { colour, align: "center", size_px: 11, halo: palette().surface });
}

/** A line at every displacement that leads on, with where to; words of neighbours stand below each other. */
function drawWays(brush: Brush, view: View, { state }: ForcePicture): void {
  const colour = palette().accent;
  transitionsOf(state).forEach((transition, i) => {
    const threshold = [transition.when, transition.only_if ?? null].find(
      (held) => held && positionOf_mm(held) !== null,
    );
    const x_mm = threshold ? positionOf_mm(threshold) : null;
    if (!threshold || x_mm === null) return;
    const x = view.x.px(x_mm);
    const below = view.box.top + 10 + 15 * (i % 5);
    brush.line([x, x], [view.box.top, view.box.top + view.box.height], {
      colour,
      dash: [3, 3],
      opacity: 0.8,
    });
    const right = x < view.box.left + view.box.width * 0.7;
    const at = { x_px: x + (right ? 5 : -5), y_px: below };
    const words = `${shortly(threshold)} → ${transition.to}`;
    brush.text(words, at, { colour, size_px: 11, align: right ? "left" : "right", halo: palette().surface });
  });
}

function drawVibrations(brush: Brush, view: View, { document, state }: ForcePicture): void {
  const colour = series(3).colour;
  const bottom = view.box.top + view.box.height;
  vibrationsIn(document, state.name).forEach((event) => {
    const x = view.x.px(event.at_mm);
    brush.line([x, x], [bottom, bottom - 26], { colour, width_px: 2 });
    const arrow = { press: "↓", release: "↑", either: "↕" }[event.stroke ?? "press"];
    brush.text(
      `♪${arrow}`,
      { x_px: x + 4, y_px: bottom - 20 },
      { colour, size_px: 12, halo: palette().surface },
    );
  });
}

function drawFindings(brush: Brush, view: View, { state, findings }: ForcePicture): void {
  findings
    .filter((found) => found.at_mm !== null && found.state === state.name)
    .forEach((found) => {
      const refused = found.severity === "refused";
      const colour = refused ? palette().danger : palette().warning;
      const at = { x_px: view.x.px(found.at_mm!), y_px: view.box.top + view.box.height - 8 };
      brush.text(refused ? "✕" : "!", at, {
        colour,
        size_px: 14,
        weight: 700,
        align: "center",
        halo: palette().surface,
      });
    });
}

/** Draw the points of the edited row that can be pulled, the chosen one filled. */
export function drawPoints(brush: Brush, view: View, picture: ForcePicture, chosen: number): void {
  const surface = picture[picture.stroke];
  const row = surface?.force_cN[picture.row];
  if (!surface || !row) return;
  const colour = velocityColour(surface.velocity_mm_s[picture.row]!);
  const held = Math.min(chosen, row.length - 1);
  for (const column of new Set([...handlesOf(surface), held])) {
    const at = { x_px: view.x.px(surface.displacement_mm[column]!), y_px: view.y.px(row[column]!) };
    const fill = column === held ? colour : palette().surface;
    brush.circle(at, column === held ? 5.5 : 4, { colour: fill }, { colour, width_px: 1.6 });
  }
}

/** Draw the edited stroke as a map: displacement to the right, velocity up, the darker the stronger. */
export function drawHeat(brush: Brush, view: View, picture: ForcePicture): void {
  const surface = picture[picture.stroke];
  if (!surface) return;
  const strongest_cN = Math.max(1, ...surface.force_cN.map((row) => Math.max(...row.map(Math.abs))));
  const { accent, danger } = palette();
  const [columns, rows] = [
    edges(view.box.left, view.box.width, CELLS.x),
    edges(view.box.top, view.box.height, CELLS.y),
  ];
  for (let i = 0; i < CELLS.x; i += 1)
    for (let j = 0; j < CELLS.y; j += 1) {
      const box = {
        left: columns[i]!,
        top: rows[j]!,
        width: columns[i + 1]! - columns[i]!,
        height: rows[j + 1]! - rows[j]!,
      };
      const at = [view.x.value(box.left + box.width / 2), view.y.value(box.top + box.height / 2)] as const;
      const force_cN = forceAt_cN(surface, ...at);
      brush.rect(box, { colour: force_cN < 0 ? danger : accent, opacity: Math.abs(force_cN) / strongest_cN });
    }
  for (const speed of surface.velocity_mm_s) {
    const y = view.y.px(speed);
    brush.line([view.box.left, view.box.left + view.box.width], [y, y], {
      colour: palette().text,
      dash: [2, 4],
      opacity: 0.7,
    });
  }
  mapWords(brush, view, `darkest: ${force(strongest_cN, 0)}; dashed: velocities that have a row`);
}

/** Whole pixels, so that neighbouring cells neither overlap nor leave a gap. */
function edges(from: number, size: number, count: number): readonly number[] {
  return Array.from({ length: count + 1 }, (_, i) => Math.round(from + (i * size) / count));
}

/** Words on the map stand on a ground of their own. */
function mapWords(brush: Brush, view: View, words: string): void {
  const { text, surface } = palette();
  const { left, top } = view.box;
  const ground = { left: left + 4, top: top + 4, width: 6.4 * words.length, height: 20 };
  brush.rect(ground, { colour: surface, opacity: 0.85 });
  brush.text(words, { x_px: left + 10, y_px: top + 14 }, { colour: text, size_px: 12 });
}
