/** Tap along with a light: finds screens that are much later than stated. */

import { button, h, onCleanup, panel, shown, signal } from "../../ui";
import { delays, type FrameClock, setDelays } from "./delays";
import { AHEAD, type Tapped, tapped } from "./taps";

const PERIOD_ms = 800;
const FLASHES = 24;
const LIT_ms = 120;

export function tapAlong(frameClock: FrameClock): HTMLElement {
  const taps = signal<readonly number[]>([]);
  const start_ms = signal<number | null>(null);
  const found = signal<Tapped | null>(null);
  const lit = signal(false);
  let pictures = 0;
  onCleanup(() => cancelAnimationFrame(pictures));
  const picture = (now_ms: number) => {
    frameClock.take(now_ms);
    if (start_ms.peek() === null) start_ms.set(now_ms);
    const since_ms = now_ms - (start_ms.peek() as number);
    lit.set(since_ms % PERIOD_ms < LIT_ms);
    if (since_ms < FLASHES * PERIOD_ms) pictures = requestAnimationFrame(picture);
    else end();
  };
  const begin = () => {
    taps.set([]);
    found.set(null);
    start_ms.set(null);
    pictures = requestAnimationFrame(picture);
    pad.focus();
  };
  const end = () => {
    found.set(tapped(taps.peek(), start_ms.peek() ?? 0, PERIOD_ms));
    lit.set(false);
    start_ms.set(null);
  };
  const tap = (at_ms: number) => start_ms.peek() !== null && taps.update((all) => [...all, at_ms]);
  const key = (event: KeyboardEvent) => {
    if (event.key !== " ") return;
    event.preventDefault();
    if (!event.repeat) tap(event.timeStamp);
  };
  const pad = h("div", {
    class: () => `opt-flash${lit() ? " lit" : ""}`,
    tabindex: 0,
    role: "application",
    "aria-label": "Tap here with the light, or the space bar",
    on: { keydown: key, pointerdown: (event) => tap(event.timeStamp) },
  });
  return panel(
    "Tap along",
    h(
      "p",
      {},
      `Tap with every flash, ${FLASHES} of them. It measures screen and hand together, and people tap ahead of a beat by ${AHEAD.ms} ± ${AHEAD.error_ms} ms without noticing: it detects a very late screen, but is otherwise no better than the stated values.`,
    ),
    pad,
    h(
      "div",
      { class: "row" },
      button({ label: "Start tapping", act: begin, disabled: () => start_ms() !== null }),
      h("span", { role: "status" }, () => (start_ms() === null ? "" : `${taps().length} taps`)),
    ),
    () => result(found()),
  );
}

function result(found: Tapped | null): HTMLElement | null {
  if (!found) return null;
  const use = () => {
    const key = delays.peek().input.key;
    const error_ms = Math.hypot(found.both_error_ms, key.error_ms);
    setDelays({ ...delays.peek(), display: { ms: Math.max(0, found.both_ms - key.ms), error_ms } });
  };
  return h(
    "div",
    { class: "row" },
    h(
      "p",
      {},
      `Your taps came ${shown(found.late_ms, 0)} ± ${shown(found.late_error_ms, 0)} ms after the flash was drawn (spread ${shown(found.spread_ms, 0)} ms, ${found.count} taps): screen and hand are ${shown(found.both_ms, 0)} ± ${shown(found.both_error_ms, 0)} ms late.`,
    ),
    button({ label: "Use it for the screen", act: use }),
  );
}
