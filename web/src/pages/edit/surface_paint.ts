/** The surfaces of a button, painted from behind. */

import { type Brush, CanvasBrush, palette, series } from "../../draw";
import { type Stroke, surface, surfaceGrid } from "../../math";
import { type FDVVModel, velocities_mm_s } from "../../model";
import { paintAxes } from "./surface_axes";
import { type Corner, facesFromBehind, type Seen, seen, type Turn } from "./surface_scene";

const ROWS = 22;
const COLUMNS = 44;

/** What a view shows: the ranges of its box, and the strokes' grids in it. */
interface Scene {
  readonly travel_mm: number;
  readonly velocity_mm_s: readonly [number, number];
  readonly force_cN: readonly [number, number];
  readonly grids: readonly { readonly stroke: Stroke; readonly corners: readonly (readonly Corner[])[] }[];
}

/** The scene of the strokes that have a surface; null if none has. */
export function sceneOf(model: FDVVModel, strokes: readonly Stroke[]): Scene | null {
  const grids = strokes
    .filter((stroke) => velocities_mm_s(model, stroke).length > 1)
    .map((stroke) => {
      const [velocity, displacement] = surfaceGrid(model, stroke, ROWS, COLUMNS);
      return surface(model, stroke, velocity, displacement);
    });
  if (!grids.length) return null;
  const all = grids.flatMap((grid) => [...grid.velocity_mm_s]);
  const [slow, fast] = [Math.min(...all), Math.max(...all)];
  let [low, high] = [0, 1];
  for (const { force_cN } of grids)
    for (const f of force_cN) [low, high] = [Math.min(low, f), Math.max(high, f)];
  const part = (value: number, from: number, to: number) => (2 * (value - from)) / (to - from || 1) - 1;
  return {
    travel_mm: model.travel_mm,
    velocity_mm_s: [slow, fast],
    force_cN: [low, high],
    grids: grids.map(({ stroke, displacement_mm: x, velocity_mm_s: v, force_cN: f }) => ({
      stroke,
      corners: Array.from(v, (speed, row) =>
        Array.from(
          x,
          (at, column): Corner => [
            part(at, 0, model.travel_mm),
            part(speed, slow, fast),
            part(f[row * x.length + column]!, low, high),
          ],
        ),
      ),
    })),
  };
}

interface Size {
  readonly width_px: number;
  readonly height_px: number;
}

/** Draw a scene as it is seen after turning. */
export function drawSurface(canvas: HTMLCanvasElement, size: Size, scene: Scene, turn: Turn): void {
  const { width_px, height_px } = size;
  if (width_px < 2 || height_px < 2) return;
  const ratio = devicePixelRatio || 1;
  canvas.width = Math.round(width_px * ratio);
  canvas.height = Math.round(height_px * ratio);
  const context = canvas.getContext("2d")!;
  context.scale(ratio, ratio);
  paint(new CanvasBrush(context), size, scene, turn);
}

function paint(brush: Brush, { width_px, height_px }: Size, scene: Scene, turn: Turn): void {
  const scale = Math.min(width_px / 3.7, height_px / 3.6);
  const [x0, y0] = [0.5 * width_px, 0.46 * height_px];
  const at = (corner: Corner): Seen => {
    const { x, y, behind } = seen(corner, turn);
    return { x: x0 + scale * x, y: y0 + scale * y, behind };
  };
  paintAxes(brush, at, turn, scene, width_px);
  const faces = scene.grids.flatMap(({ stroke, corners }) => {
    const positions = corners.map((row) => row.map(at));
    return facesFromBehind(positions).map((face) => ({ ...face, positions, corners, stroke }));
  });
  faces.sort((a, b) => b.behind - a.behind);
  const { surface: paper } = palette();
  for (const { row, column, positions, corners, stroke } of faces) {
    const around = [
      positions[row]![column]!,
      positions[row]![column + 1]!,
      positions[row + 1]![column + 1]!,
      positions[row + 1]![column]!,
    ];
    const [xs, ys] = [around.map((p) => p.x), around.map((p) => p.y)];
    const { colour } = series(stroke === "press" ? 0 : 1);
    brush.area(xs, ys, { colour: paper });
    brush.area(xs, ys, { colour, opacity: 0.2 + 0.32 * (corners[row]![column]![2] + 1) });
    if (row % 3 === 0)
      brush.line(xs.slice(0, 2), ys.slice(0, 2), {
        colour,
        opacity: 0.9,
        dash: stroke === "press" ? [] : [4, 3],
      });
  }
}
