/** What of a graph is seen: all of it until a person pans or zooms. */

import type { Point } from "../../programs/geometry";
import type { Graph } from "../../programs/graph_layout";
import { onCleanup, signal } from "../../ui";

const AIR = 26;
const LARGEST = 1.25;
const SMALLEST = 0.1;

/** The window on a graph, for the `viewBox` of its root. */
export class GraphView {
  private readonly size = signal({ width: 1, height: 1 });
  private readonly fingers = new Map<number, PointerEvent>();
  private readonly held = signal<{ readonly origin: Point; readonly zoom: number } | null>(null);

  private root!: SVGSVGElement;

  constructor(private readonly graph: () => Graph) {}

  /** Look at the graph that is drawn in an element, until the scope of the call ends. */
  follow(root: SVGSVGElement): void {
    this.root = root;
    const observer = new ResizeObserver(() => this.measure());
    observer.observe(root);
    onCleanup(() => observer.disconnect());
    root.addEventListener("wheel", (event) => this.wheel(event), { passive: false });
    this.listenForPinch();
  }

  /** Return the part of the graph that is seen, as a `viewBox`. */
  box(): string {
    const { width, height } = this.size();
    const { origin, zoom } = this.seen();
    return [origin.x, origin.y, width / zoom, height / zoom].map((n) => n.toFixed(2)).join(" ");
  }

  /** Pixels of the screen per pixel of the graph. */
  get zoom(): number {
    return this.seen().zoom;
  }

  /** The left upper corner of what is seen. */
  get origin(): Point {
    return this.seen().origin;
  }

  /** Where an event is, in the graph. */
  at(event: { readonly clientX: number; readonly clientY: number }): Point {
    const frame = this.root.getBoundingClientRect();
    const { origin, zoom } = this.seen();
    return {
      x: origin.x + (event.clientX - frame.left) / zoom,
      y: origin.y + (event.clientY - frame.top) / zoom,
    };
  }

  /** See everything, and go on seeing everything. */
  fit(): void {
    this.held.set(null);
  }

  /** Keep what is seen as it is, whatever becomes of the graph. */
  hold(): void {
    this.held.set(this.seen());
  }

  /** Zoom around a place, by default the middle. */
  zoomBy(factor: number, around?: Point): void {
    const { width, height } = this.size.peek();
    const { origin, zoom } = this.seen();
    const next = Math.min(4, Math.max(SMALLEST, zoom * factor));
    const at = around ?? { x: origin.x + width / zoom / 2, y: origin.y + height / zoom / 2 };
    const ratio = zoom / next;
    this.held.set({
      zoom: next,
      origin: { x: at.x + (origin.x - at.x) * ratio, y: at.y + (origin.y - at.y) * ratio },
    });
  }

  /** Move what is seen from an origin, by pixels of the screen. */
  moveFrom(origin: Point, dx: number, dy: number): void {
    const { zoom } = this.seen();
    this.held.set({ zoom, origin: { x: origin.x - dx / zoom, y: origin.y - dy / zoom } });
  }

  private seen(): { readonly origin: Point; readonly zoom: number } {
    return this.held() ?? this.whole();
  }

  private whole(): { readonly origin: Point; readonly zoom: number } {
    const { width, height } = this.size();
    const { bounds } = this.graph();
    const zoom = Math.min(LARGEST, width / (bounds.width + 2 * AIR), height / (bounds.height + 2 * AIR));
    const centre = { x: bounds.x + bounds.width / 2, y: bounds.y + bounds.height / 2 };
    return { zoom, origin: { x: centre.x - width / zoom / 2, y: centre.y - height / zoom / 2 } };
  }

  private wheel(event: WheelEvent): void {
    event.preventDefault();
    this.zoomBy(Math.exp(-event.deltaY * (event.ctrlKey ? 0.01 : 0.0015)), this.at(event));
  }

  /** Whether two fingers are on the graph. */
  get pinching(): boolean {
    return this.fingers.size > 1;
  }

  /** Two fingers zoom around the place between them, and take it along. */
  private listenForPinch(): void {
    const lift = (event: PointerEvent): void => void this.fingers.delete(event.pointerId);
    this.root.addEventListener(
      "pointerdown",
      (event) => event.pointerType === "touch" && this.fingers.set(event.pointerId, event),
    );
    this.root.addEventListener("pointerup", lift);
    this.root.addEventListener("pointercancel", lift);
    this.root.addEventListener("pointermove", (event) => {
      if (!this.fingers.has(event.pointerId)) return;
      const before = this.pinch();
      this.fingers.set(event.pointerId, event);
      const after = this.pinch();
      if (!before || !after) return;
      this.zoomBy(after.apart / before.apart, this.at(after.middle));
      this.moveFrom(
        this.origin,
        after.middle.clientX - before.middle.clientX,
        after.middle.clientY - before.middle.clientY,
      );
    });
  }

  /** Where two fingers are; null if there are not two. */
  private pinch(): { readonly middle: { clientX: number; clientY: number }; readonly apart: number } | null {
    const [a, b] = [...this.fingers.values()];
    if (!a || !b) return null;
    const middle = { clientX: (a.clientX + b.clientX) / 2, clientY: (a.clientY + b.clientY) / 2 };
    return { middle, apart: Math.max(1, Math.hypot(a.clientX - b.clientX, a.clientY - b.clientY)) };
  }

  private measure(): void {
    const { clientWidth: width, clientHeight: height } = this.root;
    const now = this.size.peek();
    if (width > 0 && height > 0 && (now.width !== width || now.height !== height))
      this.size.set({ width, height });
  }
}
