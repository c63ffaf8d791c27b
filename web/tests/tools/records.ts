/** Pointers, keys and scenes for the tests of tools. */

import { type CurveToolState, IDLE, pointerStep } from "../../src/tools/curve_tool";
import type { Scene } from "../../src/tools/reach";
import type { Act, CanvasPoint, KeyRecord, PointerRecord } from "../../src/tools/records";

export const POINTS = [
  { index: 0, x_px: 0, y_px: 100 },
  { index: 1, x_px: 50, y_px: 60 },
  { index: 2, x_px: 100, y_px: 80 },
  { index: 3, x_px: 150, y_px: 20 },
] as const;

export function scene(selection: readonly number[] = []): Scene {
  const nearestCurve = (at: CanvasPoint) => ({ index: 7, away_px: Math.abs(at.y_px - 200) });
  const away_px = (at: CanvasPoint) => Math.abs(at.y_px - 240);
  return {
    away_px,
    points: POINTS,
    handles: [{ name: "actuation", x_px: 120, y_px: 0 }],
    nearestCurve,
    selection,
  };
}

export function pointer(
  kind: PointerRecord["kind"],
  x_px: number,
  y_px: number,
  more: Partial<PointerRecord> = {},
) {
  const plain = { pointerId: 1, device: "mouse", button: 0, shift: false, held: false, time_ms: 0 } as const;
  return { kind, x_px, y_px, ...plain, ...more } satisfies PointerRecord;
}

export function key(name: string, more: Partial<KeyRecord> = {}): KeyRecord {
  return { kind: "down", key: name, shift: false, alt: false, ctrl: false, ...more };
}

/** Run events as a page would: a selection that the tool asks for is there at the next event. */
export function run(events: readonly PointerRecord[], selection: readonly number[] = []) {
  let state: CurveToolState = IDLE;
  let selected = selection;
  const acts: Act[] = [];
  for (const event of events) {
    const step = pointerStep(state, event, scene(selected));
    state = step.state;
    for (const act of step.acts) if (act.kind === "select") selected = act.points;
    acts.push(...step.acts);
  }
  return { state, acts, selected, kinds: acts.map((a) => a.kind) };
}
