/** Have the hand heard: a key anywhere, mouse, touch and pen on the pad. */

import { onCleanup } from "../ui";
import type { InputDevice } from "./game";

/** What the hand plays on. */
export interface Played {
  /** Whether what the hand does is heard now. */
  playing(): boolean;
  press(at_ms: number, hand: InputDevice): void;
  release(at_ms: number): void;
}

/** A key by what it writes: the space bar, wherever it lies. */
export const SPACE_BAR = (event: KeyboardEvent): boolean => event.key === " ";

/** Hear a key until the scope in which this is called ends. other: another key was pressed while one plays. */
export function followKey(
  play: Played,
  counts: (event: KeyboardEvent) => boolean,
  other: (event: KeyboardEvent) => void = () => undefined,
): void {
  const down = (event: KeyboardEvent) => {
    if (!play.playing() || event.ctrlKey || event.altKey || event.metaKey) return;
    if (!counts(event)) return other(event);
    event.preventDefault();
    event.stopPropagation();
    if (!event.repeat) play.press(event.timeStamp, "key");
  };
  const up = (event: KeyboardEvent) => {
    if (!counts(event)) return;
    // a button that has the focus must not take it for a click
    if (play.playing()) event.preventDefault();
    play.release(event.timeStamp);
  };
  const lost = () => play.release(performance.now());
  document.addEventListener("keydown", down, true);
  document.addEventListener("keyup", up, true);
  addEventListener("blur", lost);
  onCleanup(() => {
    document.removeEventListener("keydown", down, true);
    document.removeEventListener("keyup", up, true);
    removeEventListener("blur", lost);
  });
}

/** Hear mouse, touch and pen on an element. */
export function followPointer(play: Played, pad: HTMLElement): void {
  pad.addEventListener("pointerdown", (event) => {
    if (event.button !== 0 || !play.playing()) return;
    event.preventDefault();
    play.press(event.timeStamp, handOf(event));
  });
  for (const end of ["pointerup", "pointercancel", "pointerleave"] as const)
    pad.addEventListener(end, (event) => play.release(event.timeStamp));
}

function handOf(event: PointerEvent): InputDevice {
  return event.pointerType === "touch" || event.pointerType === "pen" ? event.pointerType : "mouse";
}
