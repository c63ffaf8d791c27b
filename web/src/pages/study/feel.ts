/** What is under the finger: the key from the side, its click, and hands that press it. No force is drawn. */

import { h, onCleanup } from "../../ui";
import { Clicker, FingerInput, stageCanvas, stageScale } from "../press/stage";
import type { StudySession } from "./session";
import { word } from "./words";

/** How fast the space bar presses, and with what push at the bottom. */
const SPEED_mm_s = 120;
const PUSH_cN = 120;
const LIFTED_mm = -2;
const TOUCHED_mm = 0.02;
const TRAVEL_mm = 4;

export function feelView(session: StudySession, hint: () => string): HTMLElement {
  const clicker = new Clicker();
  const hands = new FingerInput(session, {
    speed_mm_s: () => SPEED_mm_s,
    push_cN: () => PUSH_cN,
    used: () => clicker.wake(),
  });
  const cap_mm = () => session.frame()?.displacement_mm ?? 0;
  const see = () => {
    const ready = session.ready();
    if (!ready || session.onTable() || !session.felt() || session.going()) return null;
    const aim_mm = hands.aim_mm();
    const finger_mm = cap_mm() > TOUCHED_mm ? cap_mm() : Math.min(0, aim_mm ?? LIFTED_mm);
    const frame = {
      displacement_mm: [cap_mm()],
      finger_mm: [finger_mm],
      force_cN: [],
      key: session.frame()?.key ? 1 : 0,
    };
    return { ready: { travel_mm: ready.travel_mm, places: [] }, frame, aim_mm, blind: true };
  };
  session.onReady = (ready) => clicker.load(ready.signals);
  session.onFelt = () => hands.lift(performance.now());
  session.onFrame = (frame) => {
    clicker.follow(frame.t_s + frame.dropped_s);
    for (const click of frame.clicks)
      clicker.click(click.sound, click.t_s + frame.dropped_s, click.velocity_mm_s);
  };
  const element: HTMLElement = h(
    "div",
    {
      class: () =>
        `study-feel${session.felt() && !session.going() ? " there" : ""}${session.onTable() ? " table" : ""}`,
      tabindex: 0,
      role: "application",
      "data-key": () => String(session.frame()?.key ?? false),
      "aria-label": word(session.language.peek(), "press"),
    },
    stageCanvas(see, () => undefined),
    h("p", { class: "study-feel-said", "aria-live": "polite" }, () => said(session, hint)),
  );
  hands.onPointer(
    element,
    () => stageScale(session.travel_mm() ?? TRAVEL_mm, element.clientHeight),
    () => session.frame.peek()?.displacement_mm ?? 0,
  );
  hands.onKeys();
  onCleanup(() => {
    session.onReady = () => undefined;
    session.onFelt = () => undefined;
    session.onFrame = () => undefined;
    clicker.close();
  });
  return element;
}

function said(session: StudySession, hint: () => string): string {
  const language = session.language.peek();
  if (session.going()) return word(language, "switching", { label: session.going() });
  const label = session.felt();
  return label ? word(language, "pressing", { label }) : hint();
}
