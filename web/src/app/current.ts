/** The button that a person works on: pages carry it to the next one. */

import { type Signal, signal } from "../ui/signal.svelte";
import { packageOf } from "./absent";
import { address, route } from "./route";

const KEPT = "fdvv-current";

/** Id of the button, such as `builtin:mx-clear` or `own:Mine`; empty before there is one. */
export const current: Signal<string> = signal(sessionStorage.getItem(KEPT) ?? "");

/** The button that another page asked for, else the one that is worked on; empty if there is none. */
export function askedButton(): string {
  return route().query.get("button") || current();
}

/** Make a button the one that is worked on. */
export function workOn(button: string): void {
  if (button === current.peek()) return;
  current.set(button);
  sessionStorage.setItem(KEPT, button);
}

/** The address of the last comparison, so that who comes back to it finds it as it was. */
const compared: Signal<string> = signal("");

/** Keep the comparison that is shown. */
export function keepComparison(query: URLSearchParams): void {
  if (query.toString() !== compared.peek()) compared.set(query.toString());
}

function comparisonWith(button: string): Record<string, string> | URLSearchParams {
  const last = new URLSearchParams(compared());
  if (!button || last.getAll("over").includes(button)) return last;
  return { over: button };
}

export interface Task {
  readonly page: string;
  readonly label: string;
  readonly hint: string;
  /** Return the address of the task with a button; none: empty. */
  readonly at: (button: string) => string;
}

/** What is done with a button, in the order in which it is usually done. */
export const TASKS: readonly Task[] = [
  {
    page: "library",
    label: "Compare",
    hint: "Find and compare buttons",
    at: (button) => address("library", "", comparisonWith(button)),
  },
  {
    page: "edit",
    label: "Edit",
    hint: "Draw curves and vibrations",
    at: (button) => address("edit", button),
  },
  {
    page: "press",
    label: "Press",
    hint: "Press it, simulated",
    at: (button) => address("press", button),
  },
  {
    page: "live",
    label: "Rig",
    hint: "Capture it, render it, tune its vibration",
    at: (button) => address("live", "compensate", button ? { button } : {}),
  },
  {
    page: "optimize",
    label: "Optimise",
    hint: "Find the button you play best with",
    at: (button) => address("optimize", "", button ? { button } : {}),
  },
  {
    page: "studies",
    label: "Study",
    hint: "Compare buttons blind, with participants",
    at: (button) => address("studies", "", button ? { button } : {}),
  },
];

/** The tasks whose pages are installed. */
export function tasksHere(): readonly Task[] {
  return TASKS.filter(({ page }) => !packageOf(page));
}
