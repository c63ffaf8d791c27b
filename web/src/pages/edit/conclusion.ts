/** What the button that is edited comes to, and the next step. */

import { address } from "../../app/route";
import type { Verdict } from "../../app/verdict";
import { landmarks } from "../../math";
import type { FDVVModel } from "../../model";
import { force } from "../../ui/force";

/** Return what the slowest press of a model is like; the next step is to press it. */
export function conclusionOf(model: FDVVModel, id: string): Verdict {
  return { sentence: sentenceOf(model), next: { label: "Press it", to: address("press", id) } };
}

/** Say in one sentence how a model feels. */
function sentenceOf(model: FDVVModel): string {
  const { name, actuation_mm, travel_mm } = model;
  const press = model.curves.find(({ stroke }) => stroke === "press");
  if (!press) return `${name} has no press curve yet.`;
  const { peak_cN, valley_cN, bottom_out_cN } = landmarks(model, press.velocity_mm_s);
  const bump =
    peak_cN === null || valley_cN === null
      ? `rises to ${force(bottom_out_cN)} without a bump`
      : `falls by ${force(peak_cN - valley_cN)} after its peak of ${force(peak_cN)}`;
  const acts = actuation_mm === null ? "" : `, actuates at ${actuation_mm.toFixed(2)} mm`;
  return `${name} ${bump}${acts}, and stops at ${travel_mm.toFixed(2)} mm.`;
}
