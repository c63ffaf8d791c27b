/** Have the hand heard: space bar anywhere, mouse, touch and pen on the pad. */

import { onCleanup } from "../../ui";
import type { InputDevice } from "./game";
import type { Play } from "./play";

/** Hear the hand until the scope in which this is called ends. */
export function followHand(play: Play, pad: HTMLElement): void {
  const playing = () => play.standing.peek() === "there" && play.game.peek()?.phase !== "pause";
  const down = (event: KeyboardEvent) => {
    if (event.key !== " " || !playing() || event.ctrlKey || event.altKey || event.metaKey) return;
    event.preventDefault();
    event.stopPropagation();
    if (!event.repeat) play.press(event.timeStamp, "key");
  };
  const up = (event: KeyboardEvent) => {
    if (event.key !== " ") return;
    // a button that has the focus must not take it for a click
    if (playing()) event.preventDefault();
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
  pad.addEventListener("pointerdown", (event) => {
    if (event.button !== 0 || !playing()) return;
    event.preventDefault();
    play.press(event.timeStamp, handOf(event));
  });
  for (const end of ["pointerup", "pointercancel", "pointerleave"] as const)
    pad.addEventListener(end, (event) => play.release(event.timeStamp));
}

function handOf(event: PointerEvent): InputDevice {
  return event.pointerType === "touch" || event.pointerType === "pen" ? event.pointerType : "mouse";
}
