/** The stage of the press page as a place for the designs of a run. */

import { type PressStage, pressStage } from "../press/stage";

/** Enough for the stiffest design of the paper's space, 310 cN at any place. */
const PUSH_cN = 350;

/** Make a stage that ends with its scope, and what puts it into a place of a component. */
export function stageNode(): { readonly stage: PressStage; readonly put: (place: HTMLElement) => void } {
  const host = document.createElement("div");
  const stage = pressStage(host, { compact: true, push_cN: PUSH_cN });
  return { stage, put: (place) => place.append(host) };
}
