/** A button is copied or renamed under a name that the person chooses. */

import { call } from "../net/call";
import { type Signal, signal } from "../ui/signal.svelte";
import { workOn } from "./current";
import { nameOf } from "./names";
import { go, route } from "./route";

export interface Naming {
  readonly title: string;
  /** What the person may keep. */
  readonly proposal: string;
  /** Of the button that does it. */
  readonly label: string;
  /** Throws one line if the name cannot be taken. */
  readonly act: (name: string) => Promise<void>;
}

/** The name that is asked for now; null if none is. */
export const naming: Signal<Naming | null> = signal<Naming | null>(null);

/** Ask for a name, make a copy of a button and edit it. */
export function copyButton(button: string): void {
  naming.set({
    title: `Copy ${nameOf(button)}`,
    proposal: `${nameOf(button)} copy`,
    label: "Copy and edit",
    act: async (name) => {
      const made = await call("document.copy", { button, name });
      workOn(made.button);
      go("edit", made.button);
    },
  });
}

/** Ask for another name of a button of one's own; the page that shows it goes on with it. */
export function renameButton(button: string): void {
  naming.set({
    title: `Rename ${nameOf(button)}`,
    proposal: nameOf(button),
    label: "Rename",
    act: async (name) => {
      const made = await call("document.rename", { button, name });
      workOn(made.button);
      const { page, id, query } = route.peek();
      if (id === button) go(page, made.button, query);
    },
  });
}
