/** What the button says: lamp, counters, the last press, the program's state, limits and faults. */

import { button, type Child, h, shown } from "../../ui";
import type { PressSession } from "./session";

const DERATED = 4;

/** Lamp and counters, for those who see them and those who hear them. */
export function readout(session: PressSession): HTMLElement {
  const on = () => (session.frame()?.key ?? 0) > 0;
  const key = () => {
    const level = session.frame()?.key ?? 0;
    return level > 1 ? `key down, level ${level}` : level ? "key down" : "key up";
  };
  return h(
    "div",
    { class: "press-readout" },
    h(
      "div",
      { class: () => `press-lamp${on() ? " on" : ""}`, "data-key": () => String(session.frame()?.key ?? 0) },
      h("i", { "aria-hidden": "true" }),
      key,
    ),
    h(
      "dl",
      {},
      pair("actuations", () => String(session.actuations()), "actuations"),
      pair("presses", () => String(session.presses()), "presses"),
      pair("last press", () => lastPress(session), "last-press"),
      // a plain button's states are up and down, as the lamp says
      pair(
        "state",
        () => stateName(session),
        "state",
        () => session.ready()?.actuation_mm !== null,
      ),
    ),
    h("p", { class: "press-limit" }, () => limits(session)),
  );
}

function pair(
  label: string,
  value: () => string,
  name: string,
  hidden: () => boolean = () => false,
): HTMLElement {
  return h("div", { hidden }, h("dt", {}, label), h("dd", { "data-value": name }, value));
}

function lastPress(session: PressSession): string {
  const press = session.lastPress();
  return press
    ? `${shown(press.displacement_mm, 2)} mm at ${shown(press.velocity_mm_s, 0)} mm/s`
    : "none yet";
}

function stateName(session: PressSession): string {
  const frame = session.frame();
  return (frame && session.ready()?.states[frame.state]) || "–";
}

function limits(session: PressSession): string {
  const frame = session.frame();
  if (!frame) return "";
  const notes = [];
  if (frame.saturated) notes.push("the command is clipped at a limit of the rig");
  if (session.opened()) notes.push(session.opened());
  if (frame.mode === DERATED) notes.push("the coil is warm: less force");
  if (frame.dropped_s > 0) notes.push(`${shown(frame.dropped_s, 2)} s dropped: this machine was busy`);
  return notes.join("; ");
}

/** Faults with their reason, and the way out; how the press stands otherwise. */
export function standing(session: PressSession): HTMLElement {
  const line = (): Child => {
    if (session.fault()) return fault(session);
    const reason = session.reason();
    switch (session.standing()) {
      case "starting":
        return h("p", { class: "muted" }, "loading …");
      case "paused":
        return h("p", { class: "muted" }, "paused; touch it to resume");
      case "lost":
        return h("p", { class: "press-wrong" }, "no connection; it restarts when the studio is back");
      case "over":
        return h("p", { class: "press-wrong" }, reason || "no button loaded");
      default:
        return reason ? h("p", { class: "press-wrong" }, reason) : null;
    }
  };
  return h("div", { class: "press-standing", role: "status" }, line);
}

function fault(session: PressSession): HTMLElement {
  return h(
    "div",
    { class: "press-fault", role: "alert" },
    h("strong", {}, "Fault: no force. "),
    h("span", {}, session.fault()),
    button({ label: "Clear the fault", kind: "main", act: () => session.clearFault() }),
  );
}
