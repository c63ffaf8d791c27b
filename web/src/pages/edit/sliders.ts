/** The handles of the canvas for keys and screen readers: sliders that lie where the handles are drawn. */

import { effect, h } from "../../ui";
import { nudgeEnd, type NudgeAct, type NudgeState, nudgeStep, STILL } from "../../tools/nudge";
import type { EditorCanvas } from "./canvas";
import type { Desk } from "./desk";
import { keyRecord } from "./events";
import { handlesOnCanvas, heldPlace, type PlaceHandle, placeHandles } from "./handles";

const NAMES = ["travel", "actuation", "reset", "onset"] as const;
const SAID: Readonly<Record<PlaceHandle["name"], string>> = {
  travel: "Travel",
  actuation: "Actuation point",
  reset: "Reset point",
  onset: "Onset of the vibration",
};

/** One slider for each handle that a model can have; hidden where it has none. */
export function placeSliders(desk: Desk, canvas: EditorCanvas): HTMLElement[] {
  return NAMES.map((name) => slider(desk, canvas, name));
}

function slider(desk: Desk, canvas: EditorCanvas, name: PlaceHandle["name"]): HTMLElement {
  const place = () => placeHandles(desk.model(), desk.active()).find((one) => one.name === name);
  const element = h("div", {
    class: "edit-slider",
    role: "slider",
    tabindex: 0,
    "aria-label": SAID[name],
    "aria-orientation": "horizontal",
    "aria-valuemin": 0,
    "aria-valuemax": () => (name === "travel" ? 20 : desk.model().travel_mm),
    "aria-valuenow": () => place()?.at_mm ?? null,
    "aria-valuetext": () => `${(place()?.at_mm ?? 0).toFixed(3)} mm`,
    hidden: () => !place(),
  });
  effect(() => {
    const at = handlesOnCanvas(canvas.plot.view(), desk.model(), desk.curve()).find((one) => one.name === name);
    if (at) element.style.transform = `translate(${at.x_px - 9}px, ${at.y_px - 9}px)`;
  });
  listen(desk, element, name);
  return element;
}

function listen(desk: Desk, element: HTMLElement, name: PlaceHandle["name"]): void {
  let state: NudgeState = STILL;
  let from: PlaceHandle | undefined;
  const act = (one: NudgeAct) => {
    if (one.kind === "begin") {
      from = placeHandles(desk.model(), desk.active()).find((place) => place.name === name);
      desk.mark(`move ${name}`);
    } else if (one.kind === "nudge" && from) {
      desk.drag(from.edit(heldPlace(desk.settled.peek(), name, from.at_mm + one.by.dx_mm, 0.005)));
    } else if (one.kind === "commit") desk.release();
    else if (one.kind === "cancel") desk.cancel();
  };
  const take = (event: KeyboardEvent) => {
    const told = nudgeStep(state, keyRecord(event), "x");
    state = told.state;
    told.acts.forEach(act);
    if (told.acts.length) event.preventDefault();
  };
  element.addEventListener("keydown", take);
  element.addEventListener("keyup", take);
  element.addEventListener("blur", () => {
    const told = nudgeEnd(state);
    state = told.state;
    told.acts.forEach(act);
  });
}
