/** Events of the browser as the tools' plain records. */

import type { CanvasPoint, KeyRecord, PointerRecord } from "../../tools/records";

const KINDS: Readonly<Record<string, PointerRecord["kind"]>> = {
  pointerdown: "down",
  pointermove: "move",
  pointerup: "up",
};

/** A pointer event at a place of the canvas; `held` tells that the key for panning is down. */
export function pointerRecord(event: PointerEvent, { x_px, y_px }: CanvasPoint, held = false): PointerRecord {
  const device = event.pointerType === "touch" || event.pointerType === "pen" ? event.pointerType : "mouse";
  const { pointerId, button, shiftKey: shift, timeStamp: time_ms } = event;
  return { kind: KINDS[event.type] ?? "cancel", pointerId, device, button, shift, held, time_ms, x_px, y_px };
}

/** A key event. */
export function keyRecord(event: KeyboardEvent): KeyRecord {
  const kind = event.type === "keyup" ? "up" : "down";
  return {
    kind,
    key: event.key,
    shift: event.shiftKey,
    alt: event.altKey,
    ctrl: event.ctrlKey || event.metaKey,
  };
}
