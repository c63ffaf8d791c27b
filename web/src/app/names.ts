/** What buttons are called, by their ids. */

import { call } from "../net/call";
import { type Signal, signal } from "../ui/signal.svelte";

const known: Signal<ReadonlyMap<string, string>> = signal(new Map());
const asked = new Set<string>();

/** Return the name of a button; what its id says until the server has answered. */
export function nameOf(button: string): string {
  const name = known().get(button);
  if (name === undefined && /^(own|builtin):/.test(button)) return button.slice(button.indexOf(":") + 1);
  if (name === undefined && button) void ask(button);
  return name ?? button;
}

async function ask(button: string): Promise<void> {
  if (asked.has(button)) return;
  asked.add(button);
  // a button that is gone keeps its id as its name
  const { buttons } = await call("library.curves", { ids: [button] }).catch(() => ({ buttons: [] }));
  for (const { id, name } of buttons) known.update((all) => new Map(all).set(id, name));
}
