/** What forms offer: asked for when the page opens, and again when a job has left something. */

import { call, type WorkChoices } from "../../net";
import { type Signal, signal, tell } from "../../ui";
import { askedButton } from "./where";

export const choices: Signal<WorkChoices | null> = signal<WorkChoices | null>(null);

export function refreshChoices(): void {
  call("jobs.choices", {}).then((found) => choices.set(found), tell);
}

export type Option = readonly [string, string];

/** The buttons to choose from; one that another page asked work for is among them, whatever it is. */
export function buttonOptions(found: WorkChoices, vibrating = false): readonly Option[] {
  const asked = askedButton();
  const known = found.buttons.filter((button) => button.vibrates || !vibrating);
  const options = known.map(
    (one): Option => [one.button, `${one.name}${one.button.startsWith("own:") ? " (own)" : ""}`],
  );
  return !asked || found.buttons.some((button) => button.button === asked)
    ? options
    : [[asked, asked], ...options];
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

/** Name what comes out of work on a button, as a file may be named. */
export function nameFor(button: string, added: string): string {
  const name = button.slice(button.indexOf(":") + 1).replace(/[^\p{L}\p{N} .+()-]+/gu, "-");
  return `${name}${added}`.slice(0, 80);
}
