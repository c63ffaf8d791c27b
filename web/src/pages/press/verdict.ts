/** What a press was like, in one sentence, and what comes after it. */

import type { Step, Verdict } from "../../app/verdict";
import { force, shown } from "../../ui";
import type { Mode, PressSession, Stroke } from "./session";

/** How to press, where one does it and in a sentence. */
export const [HERE, HOW] = globalThis.matchMedia?.("(pointer: coarse)").matches
  ? ["Press and hold here", "Press the cap and hold it."]
  : ["Hold Space, or press here", "Hold the space bar, or press the cap with the pointer."];

const LOADING: Readonly<Record<Mode, string>> = {
  intended: "It is being put under the finger …",
  compensated: "The simulated rig learns the button: about ten seconds …",
  rendered: "It is being put on the simulated rig …",
};

/** Say what the press found, and what comes `next`; before the first one, how to press. */
export function verdictOf(session: PressSession, next: Step, mode: Mode): Verdict {
  if (session.fault()) return { sentence: "The firmware found a fault: there is no force.", kind: "warning" };
  if (session.standing() === "over") return { sentence: "Nothing is under the finger.", kind: "warning" };
  if (session.standing() === "starting") return { sentence: LOADING[mode] };
  const stroke = session.stroke();
  if (!stroke) return { sentence: HOW };
  const clicked = stroke.clicked !== null || stroke.reset_mm !== null;
  return { sentence: `${sentence(stroke)} Simulated.`, ...(clicked && { kind: "good", next }) };
}

export function sentence({ clicked, reset_mm, deepest_mm }: Stroke): string {
  const let_go = reset_mm === null ? "it stayed down" : `it let go at ${shown(reset_mm, 1)} mm`;
  if (clicked)
    return `Clicked at ${shown(clicked.displacement_mm, 1)} mm under ${force(clicked.force_cN, 0)}; ${let_go}.`;
  if (reset_mm !== null) return `Pressed to ${shown(deepest_mm, 1)} mm: ${let_go}.`;
  return `Pressed to ${shown(deepest_mm, 1)} mm, without a click: push harder.`;
}
