/** A button to press: drawn, felt as curves, heard. Any page may put one up and start things on it. */

import { type Child, h, numberField, onCleanup, type Signal, shown, signal, toggle } from "../../ui";
import { forcePlot, timePlots } from "./charts";
import { stageCanvas, stageScale } from "./drawing";
import { FingerInput } from "./finger_input";
import { readout, standing } from "./readout";
import { type Choice, PressSession } from "./session";
import { Clicker } from "./sound";
import "./stage.css";

export { stageCanvas, stageScale } from "./drawing";
export { FingerInput, type FingerTarget } from "./finger_input";
export type { Choice, Mode, What } from "./session";
export { Clicker } from "./sound";

export interface StageOptions {
  /** What is under the finger at once; later by start(). */
  readonly choice?: Choice;
  /** Without the curves over time: for a place beside something else. */
  readonly compact?: boolean;
  /** With what push the space bar presses at first; 120 if left out. */
  readonly push_cN?: number;
  /** More controls below the drawing. */
  readonly extra?: (stage: PressStage) => Child;
}

export interface PressStage {
  readonly element: HTMLElement;
  readonly session: PressSession;
  readonly hands: FingerInput;
  readonly clicker: Clicker;
  /** Put something under the finger; what leads the finger goes on leading it. */
  start(choice: Choice): void;
}

/** Put a stage into a host; call in a scope (a page's mount), whose end takes everything away. */
export function pressStage(host: HTMLElement, options: StageOptions = {}): PressStage {
  const session = new PressSession();
  const clicker = new Clicker();
  const speed_mm_s = signal(120);
  const push_cN = signal(options.push_cN ?? 120);
  const used = () => clicker.wake();
  const hands = new FingerInput(session, { speed_mm_s, push_cN, used });
  hear(session, clicker, hands);

  const view = stageView(session, hands);
  const stage: PressStage = {
    element: h("section", {
      class: `press-stage${options.compact ? " compact" : ""}`,
      "aria-label": "Button to press, simulated",
    }),
    session,
    hands,
    clicker,
    start: (choice) => session.start(choice),
  };
  const felt = forcePlot(session, options.compact ? 220 : null);
  stage.element.append(
    h(
      "div",
      { class: "press-left" },
      view,
      standing(session),
      handTools(hands, speed_mm_s, push_cN, used),
      soundTools(clicker),
      ...[options.extra?.(stage)].filter((extra) => extra instanceof Node),
    ),
    h(
      "div",
      { class: "press-right" },
      readout(session),
      h(
        "p",
        { class: "press-told" },
        h("span", { class: "tag simulated" }, "simulated"),
        () => ` ${session.ready()?.told ?? ""}`,
      ),
      felt.element,
      h("div", { class: "press-foot" }, legend(session), latencyLine(session)),
      options.compact ? null : timePlots(session),
    ),
  );
  host.append(stage.element);
  if (options.choice) stage.start(options.choice);
  onCleanup(() => clicker.close());
  return stage;
}

/** The drawing under the hand. */
function stageView(session: PressSession, hands: FingerInput): HTMLElement {
  const see = () => {
    const ready = session.ready();
    return ready && { ready, frame: session.frame(), aim_mm: hands.aim_mm() };
  };
  const drawn = () => {
    const frame = session.frame.peek();
    if (frame) session.latency.drawn(frame.sequence, performance.now());
  };
  const canvas = stageCanvas(see, drawn);
  const label = () =>
    `${session.ready()?.name ?? "no button"} under a simulated finger: press with the space bar, move with the arrow keys`;
  const element = h(
    "div",
    { class: "press-view", tabindex: 0, role: "application", "aria-label": label },
    canvas,
  );
  const scale = () => stageScale(session.ready.peek()?.travel_mm ?? 4, element.clientHeight);
  const cap_mm = () => session.frame.peek()?.displacement_mm.at(-1) ?? 0;
  hands.onPointer(element, scale, cap_mm);
  hands.onKeys();
  return element;
}

function hear(session: PressSession, clicker: Clicker, hands: FingerInput): void {
  session.onReady = (ready) => {
    clicker.load(ready.signals);
    hands.resume();
  };
  session.onFrame = (frame) => {
    // time that was dropped has passed for the ear all the same
    clicker.follow(session.rows.now_s() + frame.dropped_s);
    for (const event of frame.events)
      if (event.kind === "vibration")
        clicker.click(event.number, event.t_s + frame.dropped_s, event.velocity_mm_s);
  };
}

function handTools(
  hands: FingerInput,
  speed_mm_s: Signal<number>,
  push_cN: Signal<number>,
  used: () => void,
): HTMLElement {
  const hold = h(
    "button",
    {
      type: "button",
      class: "button press-hold",
      title: "The push grows while you hold this",
      on: {
        pointerdown: (event) => {
          used();
          hold.setPointerCapture(event.pointerId);
          hands.hold(event.timeStamp);
        },
        pointerup: (event) => hands.lift(event.timeStamp),
        pointercancel: (event) => hands.lift(event.timeStamp),
        keydown: (event) => {
          if (event.repeat || (event.key !== "Enter" && event.key !== " ")) return;
          event.preventDefault();
          used();
          hands.hold(event.timeStamp);
        },
        keyup: (event) => hands.lift(event.timeStamp),
        contextmenu: (event) => event.preventDefault(),
      },
    },
    "Hold to push",
  );
  return h(
    "div",
    { class: "press-hands" },
    h(
      "p",
      { class: "muted" },
      "Drag the finger, or hold the cap to push harder; a pen uses its pressure. Space presses, arrows move, Escape lifts.",
    ),
    h(
      "div",
      { class: "row" },
      hold,
      numberField({
        label: "Space bar",
        unit: "mm/s",
        value: speed_mm_s,
        set: speed_mm_s.set,
        least: 5,
        most: 600,
        step: 10,
        digits: 0,
      }),
      numberField({
        label: "push",
        unit: "cN",
        value: push_cN,
        set: push_cN.set,
        least: 10,
        most: 400,
        step: 10,
        digits: 0,
      }),
    ),
  );
}

function soundTools(clicker: Clicker): HTMLElement {
  const volume: HTMLInputElement = h("input", {
    type: "range",
    min: "0",
    max: "1",
    step: "0.05",
    value: String(clicker.volume),
    "aria-label": "Volume of the click",
    on: { input: () => (clicker.volume = Number(volume.value)) },
  });
  const on = signal(true);
  const set = (sound: boolean) => {
    on.set(sound);
    clicker.muted = !sound;
    clicker.wake();
  };
  return h(
    "div",
    { class: "row press-sound" },
    toggle({
      label: "Click sound",
      value: on,
      set,
      hint: "The button's vibration, louder for faster presses",
    }),
    volume,
  );
}

function legend(session: PressSession): HTMLElement {
  const one = (kind: string, text: Child) =>
    h("span", { class: `press-key ${kind}` }, h("i", { "aria-hidden": "true" }), text);
  const at = () => {
    const speed = session.target()?.velocity_mm_s ?? 0;
    return speed ? ` at ${shown(speed, 0)} mm/s` : ", slowly";
  };
  return h(
    "p",
    { class: "press-legend" },
    one("press", ["target, press", at]),
    one("release", ["target, release", at]),
    one("felt", "rendered, simulated"),
  );
}

/** How long it takes from the hand to the screen. */
function latencyLine(session: PressSession): HTMLElement {
  const said = signal("");
  const timer = setInterval(() => {
    const summary = session.latency.summary();
    if (summary)
      said.set(
        `hand to screen ${summary.median_ms.toFixed(0)} ms, 99 % within ${summary.p99_ms.toFixed(0)} ms (${summary.count} moves)`,
      );
  }, 1000);
  onCleanup(() => clearInterval(timer));
  return h("p", { class: "muted press-latency" }, said);
}
