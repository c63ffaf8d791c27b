/** What forms offer: asked for when the page opens, and again when a job has left something. */

import { askedButton, workOn } from "../../app/current";
import { call, type WorkChoices } from "../../net";
import { type Signal, signal, tell, untracked } from "../../ui";
import { nameFor } from "./fields";

export const choices: Signal<WorkChoices | null> = signal<WorkChoices | null>(null);

export function refreshChoices(): void {
  call("jobs.choices", {}).then((found) => choices.set(found), tell);
}

export type Option = readonly [string, string];

/** Options that are called what they are. */
export const same = (names: readonly string[]): readonly Option[] => names.map((name) => [name, name]);

/** The buttons to choose from; one that work was asked for is among them, whatever it is. */
export function buttonOptions(found: WorkChoices, vibrating = false): readonly Option[] {
  const asked = askedButton();
  const options = found.buttons
    .filter(({ vibrates }) => vibrates || !vibrating)
    .map(({ button, name }): Option => [button, `${name}${button.startsWith("own:") ? " (own)" : ""}`]);
  const known = !asked || found.buttons.some(({ button }) => button === asked);
  return known ? options : [[asked, asked], ...options];
}

export function deviceOptions(found: WorkChoices, use: "rig" | "bench"): readonly Option[] {
  return found.devices
    .filter((device) => device[use])
    .map(
      (one): Option => [
        one.device,
        `${one.device}${one.simulated ? " (simulated)" : ""}${one.used_by ? ", in use" : ""}`,
      ],
    );
}

interface Draft {
  button: string;
  name: string;
}

/** Choose a button, and name the result after it; a name that a person has typed stays. */
export function named(draft: Draft, button: string, added = ""): void {
  if (!draft.name || draft.name === nameFor(draft.button, added)) draft.name = nameFor(button, added);
  draft.button = button;
  workOn(button);
}

/** Begin with the button that is worked on, if it is offered; called when a form is made. */
export function chosenButton(draft: Draft, options: () => readonly Option[], added = ""): void {
  untracked(() => {
    const wanted = [askedButton(), draft.button].find((one) => options().some(([button]) => button === one));
    const button = wanted ?? options()[0]?.[0] ?? "";
    if (button) named(draft, button, added);
  });
}
