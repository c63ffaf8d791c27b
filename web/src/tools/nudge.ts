/**
 * Arrow keys move what is selected: held down they are one undo step, from the first key to the last one let go.
 *
 * One step is 1 cN and 0.05 mm; Shift makes it ten times as large, Alt a tenth.
 */

import type { KeyRecord } from "./records";

/** The step of an arrow key. */
const STEP_cN = 1;
export const STEP_mm = 0.05;

/** The total way from the beginning, in data units. */
export interface Nudge {
  readonly dx_mm: number;
  readonly dforce_cN: number;
}

/** Where the keys are: how many steps, in tenths, the held arrows have gone. */
export type NudgeState =
  | { readonly mode: "idle" }
  | {
      readonly mode: "nudging";
      readonly keys: readonly string[];
      readonly right: number;
      readonly up: number;
    };

/** What the keys ask: `begin` sets the undo mark, `nudge` tells the total way since then. */
export type NudgeAct =
  | { readonly kind: "begin" }
  | { readonly kind: "nudge"; readonly by: Nudge }
  | { readonly kind: "commit" }
  | { readonly kind: "cancel" };

/** The keys at rest. */
export const STILL: NudgeState = { mode: "idle" };

const WAYS: Readonly<Record<string, readonly [number, number]>> = {
  ArrowUp: [0, 1],
  ArrowDown: [0, -1],
  ArrowRight: [1, 0],
  ArrowLeft: [-1, 0],
};

/** Steps are counted in tenths, so that a hundred fine ones are exactly ten coarse ones. */
const TENTHS = 10;

/** One key event. `axes` tells what can move: a control point only up and down, a handle only sideways. */
export function nudgeStep(
  state: NudgeState,
  event: KeyRecord,
  axes: "x" | "y",
): { readonly state: NudgeState; readonly acts: readonly NudgeAct[] } {
  if (event.kind === "up") return released(state, event.key);
  if (event.key === "Escape" && state.mode === "nudging") return { state: STILL, acts: [{ kind: "cancel" }] };
  const offset = WAYS[event.key];
  const along = offset && (axes === "x" ? offset[0] : offset[1]);
  if (!along || event.ctrl) return { state, acts: [] };
  const tenths = along * (event.shift ? 10 * TENTHS : event.alt ? 1 : TENTHS);
  const was = state.mode === "nudging" ? state : { keys: [], right: 0, up: 0 };
  const next = {
    mode: "nudging" as const,
    keys: [...new Set([...was.keys, event.key])],
    right: was.right + (axes === "x" ? tenths : 0),
    up: was.up + (axes === "y" ? tenths : 0),
  };
  const nudge: NudgeAct = { kind: "nudge", by: total(next) };
  return { state: next, acts: state.mode === "nudging" ? [nudge] : [{ kind: "begin" }, nudge] };
}

/** Close what is going on, as when the focus leaves. */
export function nudgeEnd(state: NudgeState): {
  readonly state: NudgeState;
  readonly acts: readonly NudgeAct[];
} {
  return { state: STILL, acts: state.mode === "nudging" ? [{ kind: "commit" }] : [] };
}

function released(state: NudgeState, key: string): ReturnType<typeof nudgeEnd> {
  if (state.mode !== "nudging" || !state.keys.includes(key)) return { state, acts: [] };
  const keys = state.keys.filter((k) => k !== key);
  return keys.length ? { state: { ...state, keys }, acts: [] } : nudgeEnd(state);
}

function total({ right, up }: { readonly right: number; readonly up: number }): Nudge {
  return { dx_mm: (right * STEP_mm) / TENTHS, dforce_cN: (up * STEP_cN) / TENTHS };
}
