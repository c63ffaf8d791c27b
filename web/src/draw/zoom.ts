/** Zoom and pan of a plot by wheel, middle button and keys. */

import { followPointer } from "../ui/pointer";
import type { DataPoint, ScreenPoint } from "./scale";
import type { View } from "./types";

/** The part of a plot that zoom and pan need. */
interface Zoomable {
  readonly element: HTMLElement;
  view(): View;
  at(event: PointerEvent | WheelEvent): DataPoint & ScreenPoint;
  fit(): void;
  zoomBy(factor: number, around?: DataPoint): void;
  panBy(x_ratio: number, y_ratio: number, from: View): void;
}

export function listenForZoom(plot: Zoomable): void {
  const { element } = plot;
  const wheel = (event: WheelEvent) => {
    event.preventDefault();
    plot.zoomBy(Math.exp(event.deltaY * (event.ctrlKey ? 0.01 : 0.0015)), plot.at(event));
  };
  element.addEventListener("wheel", wheel, { passive: false });
  element.addEventListener("pointerdown", (event) => {
    if (event.button === 1) pan(plot, event);
  });
  element.addEventListener("keydown", (event) => onKey(plot, event));
}

function pan(plot: Zoomable, event: PointerEvent): void {
  event.preventDefault();
  const [start, view] = [plot.at(event), plot.view()];
  followPointer(plot.element, event, (now) => {
    const to = plot.at(now);
    plot.panBy((start.x_px - to.x_px) / view.box.width, (to.y_px - start.y_px) / view.box.height, view);
  });
}

function onKey(plot: Zoomable, event: KeyboardEvent): void {
  if (event.target !== plot.element || event.defaultPrevented) return;
  if (event.key === "+" || event.key === "=") plot.zoomBy(0.8);
  else if (event.key === "-") plot.zoomBy(1.25);
  else if (event.key === "0") plot.fit();
  else return;
  event.preventDefault();
}
