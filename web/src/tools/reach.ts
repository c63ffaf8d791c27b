/** What a pointer grips: the nearest thing within reach of the device, small things before large ones. */

import { type CanvasPoint, distance_px, type Grip, type PointerRecord } from "./records";

/** A control point on the canvas. */
export interface PointPlace extends CanvasPoint {
  readonly index: number;
}

/** A handle that moves along one axis: a grip at a place, and a line through the canvas. */
export interface HandleShown extends CanvasPoint {
  readonly name: string;
}

/** What can be gripped, as it lies on the canvas. */
export interface Scene {
  readonly points: readonly PointPlace[];
  readonly handles: readonly HandleShown[];
  /** How far the active curve is from a place. */
  readonly away_px: (at: CanvasPoint) => number;
  /** The curve nearest to a place other than the active one, and how far it is; null if there is none. */
  readonly nearestCurve: (at: CanvasPoint) => { readonly index: number; readonly away_px: number } | null;
  /** The control points that are selected. */
  readonly selection: readonly number[];
}

/** How far from a thing each device still grips it; a finger needs 44 px of target. */
const REACH_px = { mouse: 10, pen: 14, touch: 22 } as const;

/** How far a pointer may tremble before it drags. */
export const TREMBLE_px = { mouse: 3, pen: 4, touch: 8 } as const;

function nearest<T extends CanvasPoint>(things: readonly T[], at: CanvasPoint, reach_px: number): T | null {
  let found: T | null = null;
  let least = reach_px;
  for (const thing of things) {
    const away = distance_px(thing, at);
    if (away <= least) [found, least] = [thing, away];
  }
  return found;
}

/** What lies under a pointer: a point before a handle, the active curve before another one. */
export function gripAt(scene: Scene, at: CanvasPoint, device: PointerRecord["device"]): Grip {
  const reach_px = REACH_px[device];
  const point = nearest(scene.points, at, reach_px);
  if (point) return { kind: "point", index: point.index };
  const handle = nearest(scene.handles, at, reach_px);
  if (handle) return { kind: "handle", name: handle.name };
  if (scene.away_px(at) <= 0.7 * reach_px) return { kind: "line" };
  const curve = scene.nearestCurve(at);
  if (curve && curve.away_px <= reach_px) return { kind: "curve", index: curve.index };
  return { kind: "empty" };
}

/** The points inside the box between two corners, in rising order. */
export function pointsInBox(points: readonly PointPlace[], from: CanvasPoint, to: CanvasPoint): number[] {
  const [left, right] = [Math.min(from.x_px, to.x_px), Math.max(from.x_px, to.x_px)];
  const [top, bottom] = [Math.min(from.y_px, to.y_px), Math.max(from.y_px, to.y_px)];
  const inside = (p: CanvasPoint): boolean =>
    p.x_px >= left && p.x_px <= right && p.y_px >= top && p.y_px <= bottom;
  return points.filter(inside).map((p) => p.index);
}
