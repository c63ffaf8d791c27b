/** The whole button as a surface: force over displacement and velocity, press and release, turned by hand. */

import { type Brush, CanvasBrush, palette, series } from "../../draw";
import { INTERPOLATIONS, STROKES, type Stroke, surface, surfaceGrid } from "../../math";
import { type FDVVModel, setInterpolation, velocities_mm_s } from "../../model";
import { button, choice, effect, empty, h, onCleanup, panel, signal, toggle } from "../../ui";
import type { EditorController } from "./editor_controller";
import { paintAxes } from "./surface_axes";
import { type Corner, FIRST_TURN, facesFromBehind, type Seen, seen, turned } from "./surface_scene";

const ROWS = 22;
const COLUMNS = 44;
const TURN_rad_px = 0.009;
const KEY_rad = 0.12;

/** What a view shows: the ranges of its box, and the strokes' grids in it. */
interface Scene {
  readonly travel_mm: number;
  readonly velocity_mm_s: readonly [number, number];
  readonly force_cN: readonly [number, number];
  readonly grids: readonly { readonly stroke: Stroke; readonly corners: readonly (readonly Corner[])[] }[];
}

/** The panel; strokes with fewer than two known velocities have no surface. */
export function surfacePanels(editor: EditorController): HTMLElement[] {
  const shown = { press: signal(true), release: signal(true) };
  const turn = signal(FIRST_TURN);
  const canvas = h("canvas", {
    class: "edit-surface",
    tabindex: 0,
    role: "application",
    "aria-label": "Force over displacement and velocity; arrow keys turn it",
  });
  const resized = signal(0);
  const observer = new ResizeObserver(() => resized.update((n) => n + 1));
  observer.observe(canvas);
  onCleanup(() => observer.disconnect());
  const there = () => STROKES.some((stroke) => velocities_mm_s(editor.settled(), stroke).length > 1);
  effect(
    () => {
      resized();
      const scene = sceneOf(
        editor.model(),
        STROKES.filter((stroke) => shown[stroke]()),
      );
      if (scene) draw(canvas, (brush, size) => paint(brush, size, scene, turn()));
    },
    (run) => void requestAnimationFrame(run),
  );
  const by = (around: number, tilt: number) => turn.update((now) => turned(now, around, tilt));
  listen(canvas, by);
  const none = empty(
    "No surface yet",
    "A stroke needs curves at two speeds or more; copy one to another speed.",
  );
  return [
    panel(
      "Surface",
      h("div", { hidden: () => there() }, none),
      h("div", { class: "stack", hidden: () => !there() }, canvas),
      h(
        "div",
        { class: "row" },
        STROKES.map((stroke) =>
          toggle({ label: stroke, value: () => shown[stroke](), set: (on) => shown[stroke].set(on) }),
        ),
        button({ label: "Reset view", act: () => turn.set(FIRST_TURN) }),
      ),
      choice({
        label: "Force between the speeds",
        options: INTERPOLATIONS.map((one) => [one, one] as const),
        value: () => editor.settled().interpolation,
        set: (to) => void editor.apply(setInterpolation(to)),
      }),
      h("p", { class: "muted" }, "Drag or use the arrow keys to turn."),
    ),
  ];
}

function listen(canvas: HTMLElement, by: (around: number, tilt: number) => void): void {
  let last: PointerEvent | null = null;
  canvas.addEventListener("pointerdown", (event) => {
    last = event;
    canvas.setPointerCapture(event.pointerId);
  });
  canvas.addEventListener("pointermove", (event) => {
    if (last?.pointerId !== event.pointerId) return;
    by((event.clientX - last.clientX) * TURN_rad_px, (event.clientY - last.clientY) * TURN_rad_px);
    last = event;
  });
  for (const name of ["pointerup", "pointercancel"] as const)
    canvas.addEventListener(name, () => (last = null));
  canvas.addEventListener("keydown", (event) => {
    const ways: Readonly<Record<string, readonly [number, number]>> = {
      ArrowLeft: [-1, 0],
      ArrowRight: [1, 0],
      ArrowUp: [0, -1],
      ArrowDown: [0, 1],
    };
    const offset = ways[event.key];
    if (!offset) return;
    event.preventDefault();
    by(offset[0] * KEY_rad, offset[1] * KEY_rad);
  });
}

function sceneOf(model: FDVVModel, strokes: readonly Stroke[]): Scene | null {
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

function draw(canvas: HTMLCanvasElement, work: (brush: Brush, size: Size) => void): void {
  const { clientWidth: width_px, clientHeight: height_px } = canvas;
  if (width_px < 2 || height_px < 2) return;
  const ratio = devicePixelRatio || 1;
  canvas.width = Math.round(width_px * ratio);
  canvas.height = Math.round(height_px * ratio);
  const context = canvas.getContext("2d")!;
  context.scale(ratio, ratio);
  work(new CanvasBrush(context), { width_px, height_px });
}

function paint(brush: Brush, { width_px, height_px }: Size, scene: Scene, turn: typeof FIRST_TURN): void {
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
