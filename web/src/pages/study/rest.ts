/** Breaks and ends. */

import { button, h, onCleanup, signal } from "../../ui";
import type { StudySession } from "./session";
import { word } from "./words";

/** Write what is left of a break as minutes and seconds. */
export function clock(left_s: number): string {
  const whole = Math.max(0, Math.ceil(left_s));
  return `${Math.floor(whole / 60)}:${String(whole % 60).padStart(2, "0")}`;
}

export function breakScreen(session: StudySession): HTMLElement {
  const language = session.language.peek();
  const whole_s = session.step.peek()?.left_s ?? 0;
  const since_ms = session.toldAt_ms;
  const left_s = signal(whole_s);
  const tick = () => left_s.set(Math.max(0, whole_s - (performance.now() - since_ms) / 1000));
  const timer = setInterval(tick, 250);
  tick();
  onCleanup(() => clearInterval(timer));
  return h(
    "section",
    { class: "study-sheet study-break", "aria-labelledby": "study-title" },
    h("h1", { id: "study-title" }, word(language, "breakTitle")),
    h("p", {}, word(language, "breakText")),
    h("p", { class: "study-clock", role: "timer" }, () =>
      left_s() > 0 ? word(language, "breakLeft", { time: clock(left_s()) }) : word(language, "breakOver"),
    ),
    h(
      "div",
      { class: "row" },
      button({
        label: word(language, "goOn"),
        kind: "main",
        act: () => session.rested(),
        disabled: () => left_s() > 0 || session.waiting(),
      }),
    ),
  );
}

export function endScreen(title: string, text: string): HTMLElement {
  return h(
    "section",
    { class: "study-sheet", "aria-labelledby": "study-title" },
    h("h1", { id: "study-title" }, title),
    h("p", {}, text),
  );
}
