/** Set up learning, or judging what was learned. */

import type { WorkChoices } from "../../net";
import { button, choice, computed, h, numberField, type Signal, signal } from "../../ui";
import { buttonOptions, choices, deviceOptions, nameFor } from "./choices";
import { form, speedsField, textField } from "./fields";
import { type Order, startJob } from "./jobs";
import { askedButton, goToJob } from "./where";

type Compensate = Extract<Order, { type: "compensate" }>;

const draft = {
  button: signal(""),
  name: signal(""),
  device: signal("twin"),
  rig: signal("recommended"),
  speeds: signal<readonly number[]>([50, 100, 150, 200]),
  method: signal<"rig-aware" | "paper">("rig-aware"),
  rounds: signal(3),
  presses: signal(12),
  known_rig: signal(""),
  actuation: signal(""),
  probe_presses: signal(5),
  seed: signal(0),
  pace_percent: signal(35),
};

/** What a signal holds, for a control. */
export function bound<T>(to: Signal<T>): { readonly value: () => T; readonly set: (value: T) => void } {
  return { value: () => to(), set: (value) => to.set(value) };
}

export function compensateForm(): HTMLElement {
  const found = choices() as WorkChoices;
  const first = askedButton() || draft.button.peek() || found.buttons[0]?.button || "";
  draft.button.set(first);
  if (!draft.name.peek()) draft.name.set(nameFor(first, ""));
  const paper = computed(() => draft.method() === "paper");
  const tables = [
    ["", "own force, uncompensated"],
    ...found.actuations.map((name): [string, string] => [name, name]),
  ] as const;
  const judged = choice({
    label: "or only evaluate, with the table",
    options: tables,
    ...bound(draft.actuation),
  });
  return form(
    "Compensate a button on a rig",
    [
      choice({ label: "Button", options: buttonOptions(found), value: () => draft.button(), set: setButton }),
      textField({ label: "Name of the result", ...bound(draft.name) }),
      choice({ label: "Device", options: deviceOptions(found, "rig"), ...bound(draft.device) }),
      choice({
        label: "Simulated rig",
        options: found.rigs.map((name) => [name, name]),
        ...bound(draft.rig),
      }),
      speedsField({ label: "Speeds", ...bound(draft.speeds), least_mm_s: 5 }),
      choice({ label: "Method", options: METHODS, ...bound(draft.method) }),
      numberField({ label: "Rounds", unit: "", ...bound(draft.rounds), least: 0, most: 20, digits: 0 }),
      h(
        "span",
        { hidden: () => !paper() },
        numberField({
          label: "Presses per round",
          unit: "",
          ...bound(draft.presses),
          least: 1,
          most: 100,
          digits: 0,
        }),
      ),
      h("span", { hidden: paper }, knownRigs(found)),
      numberField({
        label: "Held-out presses",
        unit: "per speed",
        ...bound(draft.probe_presses),
        least: 0,
        most: 100,
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
      numberField({
        label: "Seed of the simulation",
        unit: "",
        ...bound(draft.seed),
        least: 0,
        most: 2 ** 31,
        digits: 0,
      }),
    ],
    [
      button({ label: "Start learning", kind: "main", act: () => void start() }),
      judged,
      button({
        label: "Evaluate",
        act: () => void startProbe(),
        hint: "How the rig renders the button with this table",
      }),
    ],
  );
}

const METHODS = [
  ["rig-aware", "rig-aware: starts from a model of the rig"],
  ["paper", "the paper's iterative law"],
] as const;

function knownRigs(found: WorkChoices): HTMLElement {
  const options = [
    ["", "identify it first"],
    ...found.known_rigs.map((name): [string, string] => [name, name]),
  ] as const;
  return choice({ label: "Known rig", options, ...bound(draft.known_rig) });
}

function setButton(value: string): void {
  const before = nameFor(draft.button.peek(), "");
  draft.button.set(value);
  // a name that a person has typed stays
  if (draft.name.peek() === before) draft.name.set(nameFor(value, ""));
}

async function start(): Promise<void> {
  const paper = draft.method() === "paper";
  const order: Compensate = {
    type: "compensate",
    ...shared(),
    method: draft.method(),
    rounds: draft.rounds(),
    presses: draft.presses(),
    known_rig: paper ? "" : draft.known_rig(),
    probe_presses: draft.probe_presses(),
  };
  await begin(order);
}

async function startProbe(): Promise<void> {
  const actuation = draft.actuation();
  const name = actuation || `${draft.name().trim()} uncompensated`;
  // what judges is never the chance that was learned from
  await begin({
    type: "probe",
    ...shared(),
    name,
    actuation,
    seed: draft.seed() + 1,
    presses: Math.max(1, draft.probe_presses()),
  });
}

function shared() {
  return {
    button: draft.button(),
    name: draft.name().trim(),
    device: draft.device(),
    rig: draft.rig(),
    seed: draft.seed(),
    velocities_mm_s: draft.speeds(),
    pace_ratio: draft.pace_percent() / 100,
  };
}

/** Start work, and look at it. */
export async function begin(order: Order): Promise<void> {
  const row = await startJob(order);
  if (row) goToJob(row);
}
