/** Set up a tuning of vibrations. */

import { go } from "../../app/route";
import type { WorkChoices } from "../../net";
import { button, choice, computed, empty, h, numberField, signal } from "../../ui";
import { buttonOptions, choices, deviceOptions, nameFor } from "./choices";
import { begin, bound } from "./compensateform";
import { form, speedsField, textField } from "./fields";
import { askedButton } from "./where";

const draft = {
  button: signal(""),
  name: signal(""),
  actuation: signal(""),
  device: signal("twin"),
  rig: signal("recommended"),
  speeds: signal<readonly number[]>([100]),
  observer: signal<"person" | "simulated observer">("person"),
  asking: signal<"compare" | "rate">("compare"),
  comparisons: signal(0),
  repeats: signal(3),
  seed: signal(0),
};

const ADDED = " tuned";
const OBSERVERS = [
  ["person", "you"],
  ["simulated observer", "a simulated observer (no evidence)"],
] as const;
const ASKING = [
  ["compare", "pairs: which is closer"],
  ["rate", "ratings from 1 to 7"],
] as const;

export function tuneForm(): HTMLElement {
  const found = choices() as WorkChoices;
  const options = buttonOptions(found, true);
  if (!options.length) return nothingVibrates();
  const first = askedButton() || draft.button.peek() || (options[0]?.[0] as string);
  draft.button.set(first);
  if (!draft.name.peek()) draft.name.set(nameFor(first, ADDED));
  const rating = computed(() => draft.asking() === "rate");
  const tables = [
    ["", "own force"],
    ...found.actuations.map((name): [string, string] => [name, name]),
  ] as const;
  return form(
    "Tune the vibration of a button",
    [
      choice({ label: "Button", options, value: () => draft.button(), set: setButton }),
      textField({ label: "Name of the result", ...bound(draft.name) }),
      choice({ label: "Learned table", options: tables, ...bound(draft.actuation) }),
      choice({ label: "Device", options: deviceOptions(found, "rig"), ...bound(draft.device) }),
      choice({
        label: "Simulated rig",
        options: found.rigs.map((name) => [name, name]),
        ...bound(draft.rig),
      }),
      speedsField({ label: "Speeds", ...bound(draft.speeds), least_mm_s: 5 }),
      choice({ label: "Answers come from", options: OBSERVERS, ...bound(draft.observer) }),
      choice({ label: "Questions", options: ASKING, ...bound(draft.asking) }),
      h(
        "span",
        { hidden: rating },
        numberField({
          label: "Maximum questions",
          unit: "per speed, 0: three per vibration",
          ...bound(draft.comparisons),
          least: 0,
          most: 1000,
          digits: 0,
        }),
      ),
      h(
        "span",
        { hidden: () => !rating() },
        numberField({
          label: "Ratings of each",
          unit: "times",
          ...bound(draft.repeats),
          least: 2,
          most: 20,
          digits: 0,
        }),
      ),
      numberField({
        label: "Seed",
        unit: "",
        ...bound(draft.seed),
        least: 0,
        most: 2 ** 31,
        digits: 0,
      }),
    ],
    [
      button({ label: "Start tuning", kind: "main", act: () => void start() }),
      h("span", { class: "muted" }, byEar),
    ],
  );
}

function byEar(): string {
  const simulated = !draft.device().startsWith("serial:");
  return simulated && draft.observer() === "person"
    ? "A simulated device cannot be felt: you compare by ear."
    : "";
}

function setButton(value: string): void {
  const before = nameFor(draft.button.peek(), ADDED);
  draft.button.set(value);
  if (draft.name.peek() === before) draft.name.set(nameFor(value, ADDED));
}

function nothingVibrates(): HTMLElement {
  const open = button({ label: "Open the editor", kind: "main", act: () => go("edit") });
  return empty(
    "No button with a vibration",
    "Add a press vibration to a button first, or capture one with a microphone.",
    open,
  );
}

async function start(): Promise<void> {
  await begin({
    type: "tune",
    button: draft.button(),
    name: draft.name().trim(),
    actuation: draft.actuation(),
    device: draft.device(),
    rig: draft.rig(),
    seed: draft.seed(),
    velocities_mm_s: draft.speeds(),
    observer: draft.observer(),
    asking: draft.asking(),
    comparisons: draft.comparisons(),
    repeats: draft.repeats(),
  });
}
