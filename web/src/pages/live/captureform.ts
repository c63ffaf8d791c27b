/** Set up a capture. */

import type { WorkChoices } from "../../net";
import { button, choice, computed, h, numberField, signal, toggle } from "../../ui";
import { choices, deviceOptions } from "./choices";
import { begin, bound } from "./compensateform";
import { form, speedsField, textField } from "./fields";

const BETWEEN_s = 1.2;
const COUNT_IN_s = 1.5;
const TRAVEL_mm = 4;

const draft = {
  name: signal("my button"),
  device: signal("twin"),
  switch_: signal("mx-clear"),
  participant: signal("typical"),
  paces: signal<readonly number[]>([50, 100, 150, 200]),
  presses: signal(15),
  probe: signal(true),
  shuffled: signal(false),
  repeats: signal(3),
  pace_percent: signal(35),
  watch: signal(false),
  seed: signal(0),
};

export function captureForm(): HTMLElement {
  const found = choices() as WorkChoices;
  const twin = computed(() => draft.device() === "twin");
  const only = (field: HTMLElement) => h("span", { hidden: () => !twin() }, field);
  return form(
    "Capture a real button",
    [
      textField({ label: "Name of the button", ...bound(draft.name) }),
      choice({ label: "Bench", options: deviceOptions(found, "bench"), ...bound(draft.device) }),
      only(
        choice({
          label: "Simulated switch",
          options: found.switches.map((name) => [name, name]),
          ...bound(draft.switch_),
        }),
      ),
      only(
        choice({
          label: "Simulated participant",
          options: found.participants.map((name) => [name, name]),
          ...bound(draft.participant),
        }),
      ),
      speedsField({ label: "Speeds", ...bound(draft.paces), least_mm_s: 20 }),
      numberField({
        label: "Presses",
        unit: "per speed",
        ...bound(draft.presses),
        least: 1,
        most: 200,
        digits: 0,
      }),
      numberField({
        label: "Retries of a bad press",
        unit: "times",
        ...bound(draft.repeats),
        least: 0,
        most: 20,
        digits: 0,
      }),
      numberField({
        label: "Speed tolerance",
        unit: "%",
        ...bound(draft.pace_percent),
        least: 5,
        most: 100,
        digits: 0,
      }),
      only(
        numberField({
          label: "Seed of the simulation",
          unit: "",
          ...bound(draft.seed),
          least: 0,
          most: 2 ** 31,
          digits: 0,
        }),
      ),
      toggle({ label: "A slow probe first", ...bound(draft.probe) }),
      toggle({ label: "Speeds in random order", ...bound(draft.shuffled) }),
      only(toggle({ label: "Show the cue in real time", ...bound(draft.watch) })),
    ],
    [
      button({ label: "Start the capture", kind: "main", act: () => void start() }),
      h("span", { class: "muted" }, () => lasts(twin())),
    ],
  );
}

/** How long it takes a person. */
function lasts(twin: boolean): string {
  const strokes_s = draft.paces().map((v) => COUNT_IN_s + BETWEEN_s + (2 * TRAVEL_mm) / v);
  const time_s = draft.presses() * strokes_s.reduce((sum, one) => sum + one, 0);
  const said = `about ${Math.max(1, Math.round(time_s / 60))} min with a person`;
  return twin && !draft.watch() ? `${said}; the simulated bench takes seconds` : said;
}

async function start(): Promise<void> {
  await begin({
    type: "capture",
    name: draft.name().trim(),
    device: draft.device(),
    switch: draft.switch_(),
    participant: draft.participant(),
    seed: draft.seed(),
    paces_mm_s: draft.paces(),
    presses: draft.presses(),
    probe: draft.probe(),
    shuffled: draft.shuffled(),
    repeats: draft.repeats(),
    pace_ratio: draft.pace_percent() / 100,
    watch: draft.watch(),
  });
}
