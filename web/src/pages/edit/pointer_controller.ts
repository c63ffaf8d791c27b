/** The pointer on the canvas: from events to the tool's records, and from its acts to edits. */

import type { DataPoint, View } from "../../draw";
import { controlPoints_mm, snap } from "../../math";
import { movePoints } from "../../model";
import { type CurveToolState, cancelled, IDLE, pointerStep } from "../../tools/curve_tool";
import type { Scene } from "../../tools/reach";
import type { Act, CanvasPoint, Grip, Offset, PointerRecord } from "../../tools/records";
import { batch, onCleanup } from "../../ui";
import type { EditorCanvas } from "./canvas";
import type { EditorController } from "./editor_controller";
import { pointerRecord } from "./events";
import { pointsToMove, pullAll } from "./every_speed";
import { clampedPosition, handlesOnCanvas, positionHandles } from "./handles";
import { addAt } from "./point_edits";
import { away_px, inPixels, sampled } from "./samples";
import { timed } from "./timing";

/** What a drag began with: every move is computed from it. */
interface Mark {
  readonly view: View;
  readonly start: DataPoint;
  readonly curve: ReturnType<EditorController["curve"]>;
  readonly followers: ReturnType<EditorController["followers"]>;
  readonly positions: ReturnType<typeof positionHandles>;
  readonly bumps: readonly { readonly name: string; readonly x_mm: number }[];
}

/** Listens to the pointer for as long as the page is there. */
export class PointerController {
  private state: CurveToolState = IDLE;
  private mark: Mark | null = null;
  private down: CanvasPoint = { x_px: 0, y_px: 0 };
  private space = false;

  constructor(
    private readonly editor: EditorController,
    private readonly canvas: EditorCanvas,
  ) {
    const { element } = canvas.plot;
    const listen = (name: "pointerdown" | "pointermove" | "pointerup" | "pointercancel") =>
      element.addEventListener(name, (event) => this.onPointer(event));
    for (const name of ["pointerdown", "pointermove", "pointerup", "pointercancel"] as const) listen(name);
    element.addEventListener("pointerleave", () => canvas.hover.set(null));
    element.addEventListener("contextmenu", (event) => event.preventDefault());
    const held = (event: KeyboardEvent) => {
      if (event.key === " ") this.space = event.type === "keydown" && event.target === element;
      if (this.space && event.key === " ") event.preventDefault();
    };
    addEventListener("keydown", held);
    addEventListener("keyup", held);
    onCleanup(() => {
      removeEventListener("keydown", held);
      removeEventListener("keyup", held);
      this.cancel();
    });
  }

  /** Whether something is being dragged or drawn. */
  get busy(): boolean {
    return this.state.mode !== "idle";
  }

  /** Escape, or a page that goes away. */
  cancel(): void {
    const answer = cancelled(this.state);
    this.state = answer.state;
    answer.acts.forEach((act) => this.act(act));
  }

  private onPointer(event: PointerEvent): void {
    const at = this.canvas.plot.at(event);
    if (event.type === "pointerdown") this.begin(event, at);
    const work = () =>
      batch(() => {
        this.canvas.hover.set(event.pointerType === "touch" ? null : at);
        const answer = pointerStep(this.state, this.record(event, at), this.scene());
        this.state = answer.state;
        answer.acts.forEach((act) => this.act(act));
      });
    if (this.state.mode === "dragging") timed("fdvv-hand", work);
    else work();
  }

  private begin(event: PointerEvent, at: CanvasPoint): void {
    this.down = at;
    if (this.state.mode !== "dragging") this.mark = null;
    this.canvas.plot.element.focus({ preventScroll: true });
    // the plot itself pans with the middle button
    if (event.button !== 1) this.canvas.plot.element.setPointerCapture(event.pointerId);
  }

  private record(event: PointerEvent, at: CanvasPoint): PointerRecord {
    const record = pointerRecord(event, at, this.space);
    // the plot pans with the middle button: to the tool it is one that does nothing
    return record.button === 1 ? { ...record, button: 2 } : record;
  }

  private scene(): Scene {
    const view = this.canvas.plot.view();
    const curve = this.editor.curve();
    const [x, y] = [inPixels(view.x, controlPoints_mm(curve)), inPixels(view.y, curve.control_points_cN)];
    const others = this.editor.others();
    const off = (at: CanvasPoint) => others.map((other) => away_px(sampled(other), view.x, view.y, at));
    return {
      points: Array.from(x, (x_px, index) => ({ index, x_px, y_px: y[index]! })),
      handles: handlesOnCanvas(view, this.editor.model(), curve),
      away_px: (at) => away_px(sampled(curve), view.x, view.y, at),
      nearestCurve: (at) => {
        const away = off(at);
        const index = away.indexOf(Math.min(...away));
        return index < 0 ? null : { index, away_px: away[index]! };
      },
      selection: this.editor.selection.peek(),
    };
  }

  private act(act: Act): void {
    const { editor, canvas } = this;
    switch (act.kind) {
      case "select":
        return editor.selection.set(act.points);
      case "activate":
        return editor.activate(editor.others()[act.curve]!);
      case "begin":
        return this.take(act.grip);
      case "shift":
        return this.shift(act.grip, act.offset);
      case "commit":
        return this.endDrag(() => editor.release());
      case "cancel":
        return this.endDrag(() => editor.cancel());
      case "box":
        return canvas.box.set({ from: act.from, to: act.to });
      case "box-end":
        return canvas.box.set(null);
      case "add":
        return void this.add(act.at);
      case "pan":
      case "pinch":
        return this.look(act);
    }
  }

  private take(grip: Grip): void {
    const view = this.canvas.plot.view();
    const { x_px, y_px } = this.down;
    const { editor } = this;
    const [model, curve] = [editor.model(), editor.curve()];
    const handles = handlesOnCanvas(view, model, curve);
    this.mark = {
      view,
      start: { x: view.x.value(x_px), y: view.y.value(y_px) },
      curve,
      followers: editor.followers(),
      positions: positionHandles(model, curve),
      bumps: handles.map(({ name, x_px: at }) => ({ name, x_mm: view.x.value(at) })),
    };
    editor.mark("drag");
    this.canvas.held.set(grip.kind === "handle" ? grip.name : grip.kind);
  }

  private shift(grip: Grip, { dx_px, dy_px }: Offset): void {
    const { mark, editor } = this;
    if (!mark) return;
    const { view } = mark;
    const { travel_mm } = editor.settled.peek();
    const by_cN = view.y.value(dy_px) - view.y.value(0);
    const constraints = editor.constraints.peek();
    if (grip.kind === "point") {
      const step = constraints.step_cN ?? 0;
      const points = pointsToMove(mark, editor.selection.peek());
      return editor.drag(movePoints(points, snap(by_cN, step), constraints));
    }
    if (grip.kind === "line")
      return editor.drag(pullAll(mark, mark.start.x, by_cN, { constraints, travel_mm }));
    if (grip.kind !== "handle") return;
    const bump = grip.name;
    const x_mm = mark.bumps.find(({ name }) => name === bump)?.x_mm ?? mark.start.x;
    if (bump === "peak" || bump === "valley")
      return editor.drag(pullAll(mark, x_mm, by_cN, { constraints, travel_mm, bump }));
    const position = mark.positions.find(({ name }) => name === grip.name);
    const by_mm = view.x.value(dx_px) - view.x.value(0);
    if (position)
      editor.drag(
        position.edit(clampedPosition(editor.settled.peek(), position.name, position.at_mm + by_mm)),
      );
  }

  private endDrag(end: () => void): void {
    this.mark = null;
    this.canvas.held.set(null);
    end();
  }

  private add({ x_px }: CanvasPoint): void {
    const x_mm = snap(this.canvas.plot.view().x.value(x_px), 0.01);
    addAt(this.editor, x_mm);
  }

  /** Pan and pinch, from the view that there was when it began. */
  private look(act: Extract<Act, { readonly kind: "pan" | "pinch" }>): void {
    const { plot } = this.canvas;
    this.mark ??= {
      view: plot.view(),
      start: { x: 0, y: 0 },
      curve: this.editor.curve(),
      followers: [],
      positions: [],
      bumps: [],
    };
    const { x, y } = this.mark.view;
    const around =
      act.kind === "pinch" ? { x: x.value(act.around.x_px), y: y.value(act.around.y_px) } : { x: 0, y: 0 };
    const factor = act.kind === "pinch" ? 1 / Math.max(0.05, act.ratio) : 1;
    const moved = (scale: View["x"], px: number, at: number) => {
      const by = scale.value(px) - scale.value(0);
      const seen = (edge: number) => at + (edge - at) * factor - by * factor;
      return { low: seen(scale.range.low), high: seen(scale.range.high) };
    };
    plot.window.set({ x: moved(x, act.offset.dx_px, around.x), y: moved(y, act.offset.dy_px, around.y) });
  }
}
