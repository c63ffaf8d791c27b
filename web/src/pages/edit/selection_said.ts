/** What is selected, for those who do not see the canvas. */

import { controlPoints_mm } from "../../math";
import { h } from "../../ui";
import type { Desk } from "./desk";

/** A line that screen readers read out when the selection changes, or what is selected comes to rest elsewhere. */
export function selectionSaid(desk: Desk): HTMLElement {
  const said = () => {
    desk.settled();
    const [first, ...more] = desk.selection();
    if (first === undefined) return "";
    if (more.length) return `${more.length + 1} points selected`;
    const curve = desk.curve();
    const [x_mm, force_cN] = [controlPoints_mm(curve)[first], curve.control_points_cN[first]];
    if (x_mm === undefined || force_cN === undefined) return "";
    return `point ${first + 1} of ${curve.control_points_cN.length}, ${x_mm.toFixed(2)} mm, ${force_cN.toFixed(1)} cN`;
  };
  return h("div", { class: "visually-hidden", role: "status", "aria-live": "polite" }, said);
}
