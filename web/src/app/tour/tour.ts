/** A tour through the line of work, by driver.js: the person does what it shows, and may leave at any time. */

import { type DriveStep, driver } from "driver.js";
import "driver.js/dist/driver.css";
import { workOn } from "../current";
import { parseRoute } from "../route";
import { BUTTON, STEPS, type TourStep } from "./steps";
import "./tour.css";

/** Pages are loaded and buttons opened between steps. */
const PATIENCE_ms = 15_000;

/** Begin the tour; the function given back ends it. */
export function tour(): () => void {
  let at = 0;
  const stop = new AbortController();
  const end = () => made.destroy();
  /** Go to another step and to its page; after the last one the tour is over. */
  const turn = (by: 1 | -1) => {
    const next = STEPS[at + by];
    if (!next) return end();
    at += by;
    if (page() !== next.page) location.hash = next.at();
    if (by > 0) made.moveNext();
    else made.movePrevious();
  };
  const made = driver({
    steps: STEPS.map(shown),
    popoverClass: "fdvv-tour",
    showProgress: true,
    nextBtnText: "Next",
    prevBtnText: "Back",
    doneBtnText: "Done",
    animate: false,
    // arrows move points of the curve; Escape is listened for below
    allowKeyboardControl: false,
    onNextClick: () => turn(1),
    onPrevClick: () => turn(-1),
    onPopoverRender: ({ nextButton }) => requestAnimationFrame(() => nextButton.focus()),
    onDestroyed: () => stop.abort(),
  });
  const { signal } = stop;
  addEventListener("keydown", ({ key }) => key === "Escape" && end(), { signal });
  // who goes elsewhere has left it
  addEventListener("hashchange", () => page() !== STEPS[at]?.page && end(), { signal });
  workOn(BUTTON);
  location.hash = STEPS[0]!.at();
  made.drive();
  return end;
}

function shown({ element, title, text }: TourStep): DriveStep {
  return { element, waitForElement: PATIENCE_ms, popover: { title, description: text } };
}

function page(): string {
  return parseRoute(location.hash).page;
}
