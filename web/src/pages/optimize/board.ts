/** Where one plays: the strip, the place for the hand, and what is said between rounds. */

import { call } from "../../net";
import { addShortcuts, button, h, onCleanup, type Signal, signal, tell, toggle } from "../../ui";
import type { InputDevice } from "./game";
import { Play } from "./play";
import { named, type RunStore, scoreText } from "./store";
import { stripView } from "./strip";
import { SIMULATED, table } from "./table";

const SCORES = "fdvv-scores-shown";

export interface Board {
  readonly element: HTMLElement;
  readonly play: Play;
  /** Whether a trial is being played: then nothing else may draw the eye. */
  readonly busy: () => boolean;
  /** Whether scores may be seen. */
  readonly scores: Signal<boolean>;
}

export function board(store: RunStore): Board {
  const strip = () =>
    store.detail()?.strip ?? { pixels: 144, zone_px: 100, zone_half_px: 5, speed_px_s: 100 };
  const lights = stripView(strip);
  const scores = signal(localStorage.getItem(SCORES) !== "no");
  const last = signal<number | null>(null);
  const play = new Play({
    strip,
    draw: lights.draw,
    finished: (trial) => {
      last.set(trial);
      store.chosen.set(null);
      void store.refresh().then(() => start.focus());
    },
  });
  const busy = () => play.standing() !== "away";
  const beside = table(busy);
  const where = () =>
    play.device() === SIMULATED ? "Press here, or the space bar" : "Press the button on the table";
  const pad = h(
    "div",
    { class: "opt-pad", hidden: () => !busy(), tabindex: 0, role: "application", "aria-label": where },
    h("p", { "aria-hidden": "true" }, where),
  );
  const start = startButton(store, play, pad, last, beside.device);
  follow(play, pad);
  const setScores = (on: boolean) => {
    scores.set(on);
    localStorage.setItem(SCORES, on ? "yes" : "no");
  };
  const element = h(
    "section",
    { class: () => `panel opt-board${busy() ? " busy" : ""}`, "aria-label": "Play" },
    lights.element,
    pad,
    h("p", { class: "opt-line", role: "status" }, () => line(store, play, last(), scores())),
    h(
      "div",
      { class: "row" },
      start,
      beside.element,
      pauseButton(play, pad),
      () =>
        busy()
          ? button({
              label: "Stop",
              act: () => play.close(),
              hint: "The presses so far are kept, but do not count",
            })
          : abandonButton(store),
      () => (beside.device() === SIMULATED ? soundToggle(play) : null),
      toggle({
        label: "Show scores",
        value: scores,
        set: setScores,
        hint: "After each trial; without it, you do not see how well you did",
      }),
    ),
  );
  return { element, play, busy, scores };
}

function startButton(
  store: RunStore,
  play: Play,
  pad: HTMLElement,
  last: Signal<number | null>,
  device: () => string,
): HTMLButtonElement {
  const asking = signal(false);
  const begin = async () => {
    asking.set(true);
    try {
      const { trial } = await call("optimize.next", { run: store.run });
      last.set(null);
      play.open(store.run, trial, device());
      play.clicker.wake();
      pad.focus({ preventScroll: true });
    } catch (error) {
      tell(error);
    } finally {
      asking.set(false);
    }
  };
  const label = () => {
    if (asking()) return "The engine chooses a design …";
    const open = store.open();
    return `Play trial ${(open?.number ?? store.detail()?.trials.length ?? 0) + 1}`;
  };
  return h(
    "button",
    {
      type: "button",
      class: "button main",
      hidden: () => play.standing() !== "away" || spent(store),
      disabled: asking,
      on: { click: () => void begin() },
    },
    label,
  );
}

function spent(store: RunStore): boolean {
  const row = store.detail()?.row;
  return !!row && row.spent >= row.budget && !store.open();
}

function pauseButton(play: Play, pad: HTMLElement): HTMLElement {
  const paused = () => play.game()?.phase === "pause";
  const act = () => {
    if (!paused()) return play.pause();
    play.resume();
    pad.focus({ preventScroll: true });
  };
  addShortcuts(
    { keys: "Escape", does: "Pause or resume", act: () => play.standing.peek() === "there" && act() },
    { keys: "Space, while the bullet flies", does: "Press" },
  );
  return h(
    "button",
    { type: "button", class: "button", hidden: () => play.standing() !== "there", on: { click: act } },
    () => (paused() ? "Go on" : "Pause"),
  );
}

function abandonButton(store: RunStore): HTMLElement | null {
  const open = store.open();
  if (!open) return null;
  const act = () =>
    void call("optimize.abandon", { run: store.run, trial: open.number }).then(() => store.refresh(), tell);
  return button({
    label: "Abandon this trial",
    act,
    hint: "It is not scored and does not count",
  });
}

function soundToggle(play: Play): HTMLElement {
  const on = signal(true);
  const set = (sound: boolean) => {
    on.set(sound);
    play.clicker.muted = !sound;
  };
  return toggle({
    label: "Click sound",
    value: on,
    set,
    hint: "The button's vibration as sound: all that a keyboard can render",
  });
}

/** Have the hand heard: space bar anywhere, mouse, touch and pen on the pad. */
function follow(play: Play, pad: HTMLElement): void {
  const playing = () => play.standing.peek() === "there" && play.game.peek()?.phase !== "pause";
  const down = (event: KeyboardEvent) => {
    if (event.key !== " " || !playing() || event.ctrlKey || event.altKey || event.metaKey) return;
    event.preventDefault();
    event.stopPropagation();
    if (!event.repeat) play.press(event.timeStamp, "key");
  };
  const up = (event: KeyboardEvent) => {
    if (event.key !== " ") return;
    // a button that has the focus must not take it for a click
    if (playing()) event.preventDefault();
    play.release(event.timeStamp);
  };
  const lost = () => play.release(performance.now());
  document.addEventListener("keydown", down, true);
  document.addEventListener("keyup", up, true);
  addEventListener("blur", lost);
  onCleanup(() => {
    document.removeEventListener("keydown", down, true);
    document.removeEventListener("keyup", up, true);
    removeEventListener("blur", lost);
  });
  pad.addEventListener("pointerdown", (event) => {
    if (event.button !== 0 || !playing()) return;
    event.preventDefault();
    play.press(event.timeStamp, handOf(event));
  });
  for (const end of ["pointerup", "pointercancel", "pointerleave"] as const)
    pad.addEventListener(end, (event) => play.release(event.timeStamp));
}

function handOf(event: PointerEvent): InputDevice {
  return event.pointerType === "touch" || event.pointerType === "pen" ? event.pointerType : "mouse";
}

/** What is said below the strip. */
function line(store: RunStore, play: Play, last: number | null, scores: boolean): string {
  const game = play.game();
  if (play.standing() === "opening") return "Loading the button …";
  if (game)
    return game.phase === "pause"
      ? `Paused after ${game.kept} of ${game.rounds} presses`
      : `Press ${Math.min(game.kept + 1, game.rounds)} of ${game.rounds}`;
  if (play.reason()) return play.reason();
  const trial = last === null ? undefined : store.detail()?.trials[last];
  if (trial)
    return `${statusLine(store, trial.number, scores)} ${spent(store) ? "The budget is used up: see the result." : "Play the next one when you are ready."}`;
  if (spent(store)) return "The budget is used up: see the result.";
  return "Press so that the key goes down as the bullet reaches the middle of the zone.";
}

function statusLine(store: RunStore, number: number, scores: boolean): string {
  const trial = store.detail()?.trials[number];
  const name = store.objective();
  const { label, unit } = named(name);
  if (trial?.state === "shown") return `Trial ${number + 1} is being scored.`;
  if (!scores || !trial) return `Trial ${number + 1} is done.`;
  return trial.state === "done"
    ? `Trial ${number + 1}: ${label} ${scoreText(trial.scores[name], unit)}.`
    : `Trial ${number + 1} failed: ${trial.reason}.`;
}
