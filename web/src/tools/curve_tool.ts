/**
 * The pointer on the curve canvas: idle, pointing, dragging; two fingers pinch.
 *
 * Pointing turns to dragging once the pointer has left its tremble. A drag on points or a handle is one undo step
 * between `begin` and `commit`; Escape and a lost pointer answer `cancel`, and the page goes back to its mark.
 */

import { gripAt, pointsInBox, type Scene, TREMBLE_px } from "./reach";
import {
  type Act,
  type Answer,
  type CanvasPoint,
  distance_px,
  type Grip,
  offsetBetween,
  type PointerRecord,
} from "./records";
import { toggled, united } from "./selection";

/** How soon and how near a second tap must be to count as double. */
const DOUBLE = { time_ms: 400, distance_px: 12 } as const;

interface Tap extends CanvasPoint {
  readonly time_ms: number;
}

interface Hold {
  readonly start: PointerRecord;
  /** Where the pointer was last. */
  readonly last: PointerRecord;
  readonly grip: Grip;
  /** The selection when the pointer went down. */
  readonly before: readonly number[];
}

/** Where the tool is. */
export type CurveToolState =
  | { readonly mode: "idle"; readonly tap: Tap | null }
  | ({ readonly mode: "pointing"; readonly tap: Tap | null } & Hold)
  | ({ readonly mode: "dragging" } & Hold)
  | ({ readonly mode: "boxing" } & Hold)
  | ({ readonly mode: "panning" } & Hold)
  | {
      readonly mode: "pinching";
      readonly from: readonly [PointerRecord, PointerRecord];
      readonly now: readonly [PointerRecord, PointerRecord];
    };

/** The tool at rest. */
export const IDLE: CurveToolState = { mode: "idle", tap: null };

type Transition = Answer<CurveToolState>;

const stay = (state: CurveToolState): Transition => ({ state, acts: [] });

/** One pointer event. */
export function pointerStep(state: CurveToolState, event: PointerRecord, scene: Scene): Transition {
  if (state.mode === "idle")
    return event.kind === "down" ? onPointerDown(state.tap, event, scene) : stay(state);
  if (state.mode === "pinching") return onPinch(state, event);
  if (event.kind === "down") return onSecondPointer(state, event);
  if (event.pointerId !== state.start.pointerId) return stay(state);
  if (event.kind === "cancel") return cancelled(state);
  if (state.mode === "pointing")
    return event.kind === "up" ? onTap(state, event, scene) : onDragStart(state, event, scene);
  return event.kind === "up" ? onRelease(state, event, scene) : onDrag(state, event, scene);
}

/** Escape, a lost pointer, or a page that goes away. */
export function cancelled(state: CurveToolState): Transition {
  if (state.mode === "dragging") return { state: IDLE, acts: [{ kind: "cancel" }] };
  if (state.mode === "boxing")
    return { state: IDLE, acts: [{ kind: "box-end" }, { kind: "select", points: state.before }] };
  return stay(IDLE);
}

function onPointerDown(tap: Tap | null, event: PointerRecord, scene: Scene): Transition {
  if (event.button === 2) return stay({ mode: "idle", tap: null });
  const pans = event.button === 1 || event.held;
  const grip: Grip = pans ? { kind: "empty" } : gripAt(scene, event, event.device);
  const hold = { start: event, last: event, grip, before: scene.selection };
  if (pans) return stay({ mode: "panning", ...hold });
  const state: CurveToolState = { mode: "pointing", tap, ...hold };
  if (grip.kind !== "point" || event.shift || scene.selection.includes(grip.index)) return stay(state);
  return { state, acts: [{ kind: "select", points: [grip.index] }] };
}

function onTap(
  state: Extract<CurveToolState, { mode: "pointing" }>,
  event: PointerRecord,
  scene: Scene,
): Transition {
  const { tap, start, grip } = state;
  const doubled =
    tap !== null &&
    start.time_ms - tap.time_ms <= DOUBLE.time_ms &&
    distance_px(tap, start) <= DOUBLE.distance_px;
  if (doubled && grip.kind !== "point" && grip.kind !== "handle")
    return { state: IDLE, acts: [{ kind: "add", at: start }] };
  const acts = actsOfTap(grip, start.shift, scene);
  return {
    state: { mode: "idle", tap: { x_px: event.x_px, y_px: event.y_px, time_ms: event.time_ms } },
    acts,
  };
}

function actsOfTap(grip: Grip, shift: boolean, scene: Scene): Act[] {
  switch (grip.kind) {
    case "point":
      return [{ kind: "select", points: shift ? toggled(scene.selection, grip.index) : [grip.index] }];
    case "curve":
      return [{ kind: "activate", curve: grip.index }];
    case "empty":
    case "line":
      return shift ? [] : [{ kind: "select", points: [] }];
    case "handle":
      return [];
  }
}

function onDragStart(
  state: Extract<CurveToolState, { mode: "pointing" }>,
  event: PointerRecord,
  scene: Scene,
): Transition {
  const { start, grip, before } = state;
  if (distance_px(start, event) <= TREMBLE_px[start.device]) return stay(state);
  const hold: Hold = { start, last: event, grip, before };
  if (grip.kind === "empty" || grip.kind === "curve") {
    const mode = start.device === "touch" ? "panning" : "boxing";
    return onDrag({ mode, ...hold }, event, scene);
  }
  const acts: Act[] = [];
  if (grip.kind === "point" && !scene.selection.includes(grip.index))
    acts.push({ kind: "select", points: united(scene.selection, [grip.index]) });
  acts.push({ kind: "begin", grip });
  const after = onDrag({ mode: "dragging", ...hold }, event, scene);
  return { state: after.state, acts: [...acts, ...after.acts] };
}

type Moving = Extract<CurveToolState, { mode: "dragging" | "boxing" | "panning" }>;

function onDrag(was: Moving, event: PointerRecord, scene: Scene): Transition {
  const state = { ...was, last: event };
  const offset = offsetBetween(state.start, event);
  if (state.mode === "dragging") return { state, acts: [{ kind: "shift", grip: state.grip, offset }] };
  if (state.mode === "panning") return { state, acts: [{ kind: "pan", offset }] };
  const inside = pointsInBox(scene.points, state.start, event);
  const points = state.start.shift ? united(state.before, inside) : inside;
  return {
    state,
    acts: [
      { kind: "box", from: state.start, to: event },
      { kind: "select", points },
    ],
  };
}

function onRelease(state: Moving, event: PointerRecord, scene: Scene): Transition {
  const last = onDrag(state, event, scene).acts;
  if (state.mode === "dragging") return { state: IDLE, acts: [...last, { kind: "commit" }] };
  if (state.mode === "boxing") return { state: IDLE, acts: [...last, { kind: "box-end" }] };
  return { state: IDLE, acts: last };
}

/** A second finger makes a pinch of whatever the first one does; a second mouse button changes nothing. */
function onSecondPointer(state: Extract<CurveToolState, Hold>, event: PointerRecord): Transition {
  if (event.device !== "touch" || event.pointerId === state.start.pointerId) return stay(state);
  const from = [state.last, event] as const;
  return { state: { mode: "pinching", from, now: from }, acts: cancelled(state).acts };
}

function onPinch(state: Extract<CurveToolState, { mode: "pinching" }>, event: PointerRecord): Transition {
  if (!state.now.some((p) => p.pointerId === event.pointerId)) return stay(state);
  if (event.kind === "up" || event.kind === "cancel") return stay(IDLE);
  const at = (p: PointerRecord): PointerRecord => (p.pointerId === event.pointerId ? event : p);
  const now = [at(state.now[0]), at(state.now[1])] as const;
  const around = middle(state.from);
  const offset = offsetBetween(around, middle(now));
  const ratio = distance_px(...now) / Math.max(1, distance_px(...state.from));
  return { state: { ...state, now }, acts: [{ kind: "pinch", offset, ratio, around }] };
}

function middle([a, b]: readonly [CanvasPoint, CanvasPoint]): CanvasPoint {
  return { x_px: 0.5 * (a.x_px + b.x_px), y_px: 0.5 * (a.y_px + b.y_px) };
}
