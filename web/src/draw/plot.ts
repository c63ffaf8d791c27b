/** A plot: two axes with units, a still layer and one that moves, zoom, pan and pointers in the plot's units. */

import { h } from "../ui/element";
import { effect, onCleanup, type Signal, signal } from "../ui/signal.svelte";
import { type Brush, CanvasBrush, SvgBrush } from "./brush";
import { drawFrame } from "./frame";
import { labelRoom_px, paintEndLabels } from "./labels";
import { palette } from "./palette";
import { type DataPoint, linear, type Range, type ScreenPoint } from "./scale";
import type { PlotOptions, View } from "./types";
import { listenForZoom } from "./zoom";

const MARGIN = { left: 58, right: 14, top: 12, bottom: 44 };
const SMALL = { left: 38, right: 8, top: 8, bottom: 24 };

export class Plot {
  readonly element: HTMLElement;
  /** What is seen; null sees the whole. */
  readonly window: Signal<{ readonly x: Range; readonly y: Range } | null> = signal(null);
  private readonly size = signal({ width_px: 0, height_px: 0 });
  private readonly canvases: readonly [HTMLCanvasElement, HTMLCanvasElement];
  private readonly asked = [signal(0), signal(0)] as const;
  private readonly due: [(() => void) | null, (() => void) | null] = [null, null];
  private frame = 0;

  constructor(readonly options: PlotOptions) {
    const made = () => h("canvas", { "aria-hidden": "true" });
    this.canvases = [made(), made()];
    this.element = h(
      "div",
      { class: "plot", role: "img", "aria-label": options.label, tabindex: options.zoom ? 0 : null },
      this.canvases[0],
      this.canvases[1],
    );
    if (options.height_px) this.element.style.height = `${options.height_px}px`;
    const observer = new ResizeObserver(() => this.measure());
    observer.observe(this.element);
    onCleanup(() => {
      observer.disconnect();
      cancelAnimationFrame(this.frame);
    });
    this.follow();
    if (options.zoom) listenForZoom(this);
  }

  /** Return the view of now. */
  view(): View {
    const { width_px, height_px } = this.size();
    const m = this.options.small ? SMALL : MARGIN;
    const seen = this.window() ?? this.options.whole();
    const names = this.options.ends?.().map((one) => one.text) ?? [];
    const right = m.right + labelRoom_px(names, width_px);
    const box = {
      left: m.left,
      top: m.top,
      width: Math.max(1, width_px - m.left - right),
      height: Math.max(1, height_px - m.top - m.bottom),
    };
    return {
      x: linear(seen.x, box.left, box.left + box.width),
      y: linear(seen.y, box.top + box.height, box.top),
      box,
      width_px,
      height_px,
    };
  }

  /** Draw the moving layer with the next frame, although no signal changed. */
  move(): void {
    this.asked[1].update((n) => n + 1);
  }

  /** Where an event is, in the plot's units and on the screen. */
  at(event: PointerEvent | WheelEvent | MouseEvent): DataPoint & ScreenPoint {
    const frame = this.element.getBoundingClientRect();
    const [x_px, y_px] = [event.clientX - frame.left, event.clientY - frame.top];
    const view = this.view();
    return { x_px, y_px, x: view.x.value(x_px), y: view.y.value(y_px) };
  }

  /** See everything. */
  fit(): void {
    this.window.set(null);
  }

  /** Zoom by a factor (below 1: closer) around a place. */
  zoomBy(factor: number, around?: DataPoint): void {
    const { x, y } = this.view();
    const at = around ?? { x: middle(x.range), y: middle(y.range) };
    this.window.set({ x: scaled(x.range, factor, at.x), y: scaled(y.range, factor, at.y) });
  }

  /** Move what is seen, now or in an earlier view, by parts of its size. */
  panBy(x_ratio: number, y_ratio: number, from: View = this.view()): void {
    this.window.set({ x: shifted(from.x.range, x_ratio), y: shifted(from.y.range, y_ratio) });
  }

  /** Return the plot as an SVG file. */
  toSvg(): string {
    const brush = new SvgBrush();
    const view = this.view();
    this.paint(brush, view, 0);
    this.paint(brush, view, 1);
    return brush.file(view.width_px, view.height_px, palette().surface);
  }

  /** Return the plot as a PNG file, at twice the size of the screen. */
  async toPng(): Promise<Blob> {
    const view = this.view();
    const canvas = h("canvas", { width: view.width_px * 2, height: view.height_px * 2 });
    const context = canvas.getContext("2d") as CanvasRenderingContext2D;
    context.scale(2, 2);
    context.fillStyle = palette().surface;
    context.fillRect(0, 0, view.width_px, view.height_px);
    const brush = new CanvasBrush(context);
    this.paint(brush, view, 0);
    this.paint(brush, view, 1);
    return new Promise((resolve, reject) =>
      canvas.toBlob(
        (blob) => (blob ? resolve(blob) : reject(new Error("the image could not be created"))),
        "image/png",
      ),
    );
  }

  private paint(brush: Brush, view: View, layer: 0 | 1): void {
    if (layer === 0) drawFrame(brush, view, this.options);
    const work = layer === 0 ? this.options.still : this.options.moving;
    if (work) brush.clipped(view.box, () => work(brush, view));
    if (layer === 1 && this.options.ends) paintEndLabels(brush, view, this.options.ends());
  }

  /** Each layer is painted in an effect of its own, at most once a frame. */
  private follow(): void {
    for (const layer of [0, 1] as const) {
      effect(
        () => {
          this.asked[layer]();
          this.draw(layer);
        },
        (run) => this.request(layer, run),
      );
    }
  }

  private request(layer: 0 | 1, run: () => void): void {
    this.due[layer] = run;
    if (this.frame) return;
    this.frame = requestAnimationFrame(() => {
      this.frame = 0;
      for (const one of [0, 1] as const) {
        const now = this.due[one];
        this.due[one] = null;
        now?.();
      }
    });
  }

  private draw(layer: 0 | 1): void {
    const view = this.view();
    if (view.width_px < 2 || view.height_px < 2) return;
    const canvas = this.canvases[layer];
    const context = canvas.getContext("2d") as CanvasRenderingContext2D;
    const ratio = window.devicePixelRatio || 1;
    const [width, height] = [Math.round(view.width_px * ratio), Math.round(view.height_px * ratio)];
    if (canvas.width !== width || canvas.height !== height) {
      canvas.width = width;
      canvas.height = height;
    }
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    context.clearRect(0, 0, view.width_px, view.height_px);
    this.paint(new CanvasBrush(context), view, layer);
  }

  private measure(): void {
    const { clientWidth: width_px, clientHeight: height_px } = this.element;
    const now = this.size.peek();
    if (now.width_px !== width_px || now.height_px !== height_px) this.size.set({ width_px, height_px });
  }
}

function middle(range: Range): number {
  return (range.low + range.high) / 2;
}

function scaled(range: Range, factor: number, at: number): Range {
  return { low: at + (range.low - at) * factor, high: at + (range.high - at) * factor };
}

function shifted(range: Range, ratio: number): Range {
  const by = (range.high - range.low) * ratio;
  return { low: range.low + by, high: range.high + by };
}
