/** Which screens a study has. */

import { live } from "../../net";
import { onCleanup, type Signal, signal } from "../../ui";
import { holder } from "./keep";

/** labels: they are felt and answered. timing: one presses at a bullet, or taps. Empty: not known yet. */
export type StudyScreens = "" | "labels" | "timing";
const TIMED: readonly string[] = ["timing", "tapping"];

/** Ask what a study is, again whenever the studio is back, until it has said so. */
export function kindOf(study: string, seat: string): Signal<StudyScreens> {
  const found = signal<StudyScreens>("");
  const channel = live().channel("study", {
    onMessage: (message) => {
      if (message.type !== "about") return;
      channel.close();
      found.set(TIMED.includes(message.kind) ? "timing" : "labels");
    },
    // its own screen says what is wrong
    wrong: () => {
      channel.close();
      found.set("labels");
    },
    opened: (channel) => void channel.send({ type: "look", study, seat, holder: holder(study, seat) }),
  });
  onCleanup(() => channel.close());
  return found;
}
