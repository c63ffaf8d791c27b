/** Keys of a trial: they work whatever has the focus, but not while nothing can be answered. */

import type { Shortcut } from "../../ui";
import type { StudySession } from "./session";

export function trialKey(session: StudySession) {
  return (keys: string, does: string, act: () => void): Shortcut => ({
    keys,
    does,
    act: () => !session.lost.peek() && !session.paused.peek() && act(),
    always: true,
  });
}
