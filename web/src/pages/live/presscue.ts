/** Leads a person who presses a rig: the press to make, and the cue. */

import { type Child, computed, h, panel, untracked } from "../../ui";
import { beepToggle, cueView } from "./cue";
import { watched } from "./jobs";
import { timeText } from "./motion";

const COUNT_IN_s = 1.5;
const AFTER_s = 0.3;

/** Shown while a person is asked for a press; nothing on simulated devices, which press by themselves. */
export function pressCue(): Child {
  const asked = computed(() => watched().picture.pressAsked);
  return () => {
    const ask = asked();
    if (!ask) return null;
    const stroke_s = ask.travel_mm / ask.velocity_mm_s;
    const cue = {
      travel_mm: ask.travel_mm,
      contact_s: COUNT_IN_s,
      stroke_s,
      length_s: COUNT_IN_s + 2 * stroke_s + AFTER_s,
    };
    const wanted = `Press ${ask.number} of ${ask.total}: ${ask.velocity_mm_s} mm/s, ${ask.travel_mm.toFixed(1)} mm in ${timeText(stroke_s)}, down to the stop, then release.`;
    return panel(
      "Press now",
      h("p", { class: "wanted", role: "status" }, wanted),
      untracked(() => cueView(cue, null)),
      beepToggle(),
    );
  };
}
