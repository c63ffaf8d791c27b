/**
 * What the tools live on: events as plain records, places in pixels of the canvas, and the acts they answer with.
 *
 * Tools are functions from a state and an event to a state and acts; they know neither the DOM nor the document.
 */

/** A place on the canvas, y downward. */
export interface CanvasPoint {
  readonly x_px: number;
  readonly y_px: number;
}

/** One pointer event. `button` is 0 for the main one; `held` tells that the key for panning is down. */
export interface PointerRecord extends CanvasPoint {
  readonly kind: "down" | "move" | "up" | "cancel";
  readonly pointerId: number;
  readonly device: "mouse" | "touch" | "pen";
  readonly button: number;
  readonly shift: boolean;
  readonly held: boolean;
  readonly time_ms: number;
}

/** One key event, named as `KeyboardEvent.key` names it. */
export interface KeyRecord {
  readonly kind: "down" | "up";
  readonly key: string;
  readonly shift: boolean;
  readonly alt: boolean;
  readonly ctrl: boolean;
}

/** What lies under a pointer; `line` is the active curve between its points. */
export type Grip =
  | { readonly kind: "point"; readonly index: number }
  | { readonly kind: "handle"; readonly name: string }
  | { readonly kind: "line" }
  | { readonly kind: "curve"; readonly index: number }
  | { readonly kind: "empty" };

/** A way, from where the pointer went down to where it is. */
export interface Offset {
  readonly dx_px: number;
  readonly dy_px: number;
}

/**
 * What a tool asks of the page. Between `begin` and `commit` or `cancel` lies one undo step; every `shift` tells
 * the total way from the beginning, never the way since the last one.
 */
export type Act =
  | { readonly kind: "select"; readonly points: readonly number[] }
  | { readonly kind: "activate"; readonly curve: number }
  | { readonly kind: "begin"; readonly grip: Grip }
  | { readonly kind: "shift"; readonly grip: Grip; readonly offset: Offset }
  | { readonly kind: "commit" }
  | { readonly kind: "cancel" }
  | { readonly kind: "box"; readonly from: CanvasPoint; readonly to: CanvasPoint }
  | { readonly kind: "box-end" }
  | { readonly kind: "add"; readonly at: CanvasPoint }
  | { readonly kind: "pan"; readonly offset: Offset }
  | { readonly kind: "pinch"; readonly offset: Offset; readonly ratio: number; readonly around: CanvasPoint };

/** A state and what is to be done about it. */
export interface Answer<State> {
  readonly state: State;
  readonly acts: readonly Act[];
}

/** The way between two places. */
export function offsetBetween(from: CanvasPoint, to: CanvasPoint): Offset {
  return { dx_px: to.x_px - from.x_px, dy_px: to.y_px - from.y_px };
}

/** The distance between two places. */
export function distance_px(a: CanvasPoint, b: CanvasPoint): number {
  return Math.hypot(a.x_px - b.x_px, a.y_px - b.y_px);
}
