/** The line of numbers above the canvas: where the pointer is, and what the curves say there. */

import { h } from "../../ui";
import type { HandShown } from "./canvas";
import type { Desk } from "./desk";
import type { RigView } from "./rigs";
import { wordsOf } from "./look";
import { forceNear_cN, sampled } from "./samples";

/** Numbers under the pointer; why a move goes no further, where it does not. */
export function readout(desk: Desk, rig: RigView, hand: HandShown): HTMLElement {
  const pointer = () => {
    const at = hand.hover();
    if (!at) return wordsOf(desk.active());
    const force = forceNear_cN(sampled(desk.curve()), at.x);
    return `${at.x.toFixed(3)} mm · ${at.y.toFixed(1)} cN · curve ${force.toFixed(2)} cN`;
  };
  return h(
    "div",
    { class: "edit-readout" },
    h("span", { class: "edit-pointer", "aria-hidden": "true" }, pointer),
    h("span", { class: "wrong", role: "status" }, () => desk.refusal()),
    legend(desk, rig),
  );
}

/** What the lines are, for those that are there. */
function legend(desk: Desk, rig: RigView): HTMLElement {
  const key = (kind: string, text: string) => h("span", { class: `edit-key ${kind}` }, text);
  return h("span", { class: "edit-legend" }, () => {
    const measured = rig.measured();
    const at = desk.active();
    const here = measured?.curves.some((c) => c.stroke === at.stroke && c.velocity_mm_s === at.velocity_mm_s);
    return [
      desk.showBefore() ? key("before", "before") : null,
      rig.curves().length ? key("achievable", "achievable, computed") : null,
      here ? key("measured", measured?.simulated ? "measured, simulated" : "measured") : null,
    ];
  });
}
