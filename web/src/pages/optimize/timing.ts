/** Timing: what is measured, what is assumed, and a way to measure the delays of this screen by tapping. */

import { button, h, numberField, on, onCleanup, panel, shown, signal } from "../../ui";
import { type Delay, delays, displayDelay, setDelays } from "./delays";
import type { InputDevice } from "./game";
import type { Play } from "./play";
import { SIMULATED } from "./table";
import { tapAlong } from "./tap_along";

const HANDS: readonly (readonly [InputDevice, string])[] = [
  ["key", "keyboard"],
  ["mouse", "mouse"],
  ["touch", "touch"],
  ["pen", "pen"],
];

export function timingPanel(play: Play): HTMLElement {
  // clocks go on by themselves: what is said of them is read now and then
  const beat = signal(0);
  const timer = setInterval(() => beat.update((n) => n + 1), 500);
  onCleanup(() => clearInterval(timer));
  return h(
    "div",
    { class: "opt-timing" },
    h("div", { class: "stack" }, measured(play, beat), tapAlong(play.frameClock)),
    panel(
      "Assumed until you measure them",
      h(
        "p",
        {},
        "The same for all designs of a run: an error here shifts every press alike. It is saved with every press.",
      ),
      h(
        "div",
        { class: "opt-delays" },
        () => displayRow(play, beat),
        HANDS.map(([hand, name]) => inputRow(hand, name)),
      ),
    ),
  );
}

function measured(play: Play, beat: () => number): HTMLElement {
  return panel(
    "Measured here",
    h(
      "p",
      {},
      "The bullet is on the page's clock, the key on the simulation's. A press counts from the browser's event plus the time of the simulated button: the delay between page and server is removed. A device times its key with its own clock, synchronised with the page's.",
    ),
    on(beat, () => h("dl", { class: "opt-facts" }, facts(play))),
  );
}

function facts(play: Play): HTMLElement[] {
  const [clock, summary] = [play.clock.at(performance.now()), play.clock.summary()];
  const ways = play.rounds
    .peek()
    .flatMap((round) => (round.transport_ms === null ? [] : [round.transport_ms]));
  const way = ways.sort((a, b) => a - b)[ways.length >> 1];
  return [
    fact("between two frames", `${shown(play.frameClock.frame_ms(), 2)} ms`),
    fact("clocks of page and server", clock ? `known to ± ${shown(clock.error_ms, 2)} ms` : "not yet known"),
    fact("round trip", summary ? `${shown(summary.trip_ms, 2)} ms at best` : "–"),
    play.device.peek() === SIMULATED
      ? fact(
          "hand to simulation, removed",
          way === undefined ? "after the first press" : `${shown(way, 1)} ms (median of ${ways.length})`,
        )
      : fact("key", "timed by the device's own clock"),
  ];
}

function fact(name: string, value: string): HTMLElement {
  return h("div", {}, h("dt", {}, name), h("dd", {}, value));
}

function displayRow(play: Play, beat: () => number): HTMLElement {
  const now = () => {
    beat();
    return displayDelay(delays(), play.frameClock.frame_ms());
  };
  const set = (by: Partial<Delay>) =>
    setDelays({
      ...delays.peek(),
      display: { ...displayDelay(delays.peek(), play.frameClock.frame_ms()), ...by },
    });
  const said = () => (delays().display ? "yours" : "assumed: one and a half frames plus 5 ms");
  return h(
    "div",
    { class: "row" },
    h("strong", {}, "Screen"),
    ...pair("screen", now, set),
    h("span", { class: "muted" }, said),
    button({
      label: "Use assumed",
      kind: "quiet",
      act: () => setDelays({ ...delays.peek(), display: null }),
      disabled: () => !delays().display,
    }),
  );
}

function inputRow(hand: InputDevice, name: string): HTMLElement {
  const set = (by: Partial<Delay>) => {
    const before = delays.peek();
    setDelays({ ...before, input: { ...before.input, [hand]: { ...before.input[hand], ...by } } });
  };
  return h("div", { class: "row" }, h("strong", {}, name), ...pair(name, () => delays().input[hand], set));
}

function pair(name: string, now: () => Delay, set: (by: Partial<Delay>) => void): HTMLElement[] {
  const bounds = { least: 0, most: 1000, digits: 1, unit: "ms", bare: true } as const;
  return [
    numberField({
      ...bounds,
      label: `Delay of the ${name}`,
      value: () => now().ms,
      set: (ms) => set({ ms }),
    }),
    h("span", { "aria-hidden": "true" }, "±"),
    numberField({
      ...bounds,
      label: `Uncertainty of the ${name}'s delay`,
      value: () => now().error_ms,
      set: (error_ms) => set({ error_ms }),
    }),
  ];
}
