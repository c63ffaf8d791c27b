/** Shortcuts of a page, all in one list so that a help sheet can show them. */

import { onCleanup, signal } from "./signal.svelte";

export interface Shortcut {
  /** As it is written for people: "Ctrl+Z", "Shift+ArrowUp", "/", "Space". Ctrl means Cmd on a Mac. */
  readonly keys: string;
  readonly does: string;
  /** Left out where what has the focus works the key itself: then it is only listed. */
  readonly act?: (event: KeyboardEvent) => void;
  /** Works while text is being typed too. */
  readonly always?: boolean;
}

let working: readonly Shortcut[] = [];
/** All shortcuts that work, to be shown. */
export const shortcuts = signal<readonly Shortcut[]>([]);

/** Add shortcuts for as long as the scope in which this is called lasts. */
export function addShortcuts(...added: Shortcut[]): void {
  work([...working, ...added]);
  onCleanup(() => work(working.filter((one) => !added.includes(one))));
}

/**
 * They work at once and are shown a moment later: while a component is made or goes nothing else may be drawn,
 * and one that goes would read from the signal what was in it before.
 */
function work(next: readonly Shortcut[]): void {
  working = next;
  queueMicrotask(() => shortcuts.set(working));
}

/** Write what was pressed as shortcuts are written. */
export function pressedKeys(event: KeyboardEvent): string {
  const key = event.key === " " ? "Space" : event.key.length === 1 ? event.key.toUpperCase() : event.key;
  const letter = /^[A-Z0-9]$/.test(key) || key.length > 1;
  return [
    event.ctrlKey || event.metaKey ? "Ctrl" : "",
    event.altKey ? "Alt" : "",
    event.shiftKey && letter ? "Shift" : "",
    key,
  ]
    .filter(Boolean)
    .join("+");
}

function typing(target: EventTarget | null): boolean {
  return (
    target instanceof HTMLElement &&
    target.matches("input:not([type=checkbox]):not([type=range]), select, textarea, [contenteditable]")
  );
}

/** Listen for shortcuts; called once by the shell. The last one added wins. */
export function listenForShortcuts(): void {
  document.addEventListener("keydown", (event) => {
    if (event.defaultPrevented) return;
    const pressed = pressedKeys(event);
    const found = working.findLast(
      (one) => one.act && one.keys === pressed && (one.always || !typing(event.target)),
    );
    // a focused control keeps the keys that work it
    const own =
      event.target instanceof HTMLElement &&
      event.target.matches("button, a, [role=tab], summary") &&
      (pressed === "Space" || pressed === "Enter");
    if (!found || own) return;
    event.preventDefault();
    found.act?.(event);
  });
}
