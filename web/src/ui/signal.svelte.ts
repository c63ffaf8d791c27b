/** Svelte's signals as functions, for what is no component: drawing, controllers, pages in plain TypeScript. */

import { flushSync, getAllContexts, untrack } from "svelte";

/** What must be undone when a page, or a part of it, goes. */
export type Cleanup = () => void;

export interface Signal<T> {
  /** Return the value; an effect or computed value that reads it runs again when it changes. */
  (): T;
  set(value: T): void;
  update(change: (value: T) => T): void;
  /** Return the value without following it. */
  peek(): T;
}

/** Changes that are being made together, and effects that run: what follows waits for their end. */
let depth = 0;

/** Whether Svelte is making a component: it runs who follows when it is done, and must not be asked to meanwhile. */
function making(): boolean {
  try {
    return !!getAllContexts();
  } catch {
    return false;
  }
}

/** Make changes together: who follows several of them runs once, before this returns. */
export function batch(changes: () => void): void {
  depth++;
  try {
    changes();
  } finally {
    depth--;
    if (!depth && !$effect.tracking() && !making()) flushSync();
  }
}

export function signal<T>(initial: T): Signal<T> {
  let value = $state.raw(initial);
  const read = (() => value) as Signal<T>;
  read.peek = () => untrack(read);
  read.set = (next) =>
    batch(() => {
      value = next;
    });
  read.update = (change) => read.set(change(read.peek()));
  return read;
}

/**
 * Run now, and again whenever a signal that was read changes; ends with its scope, or when called.
 *
 * A run that fails is reported as an uncaught error; the others that follow the same signal still run.
 *
 * later: given the next run to do when it suits, such as with the next frame; at once if it is left out.
 */
export function effect(work: () => void | Cleanup, later?: (run: () => void) => void): Cleanup {
  const turn = signal(0);
  let due = true;
  const run = () => {
    depth++;
    try {
      return work();
    } catch (error) {
      reportError(error);
    } finally {
      depth--;
    }
  };
  const again = () => {
    due = true;
    turn.update((n) => n + 1);
  };
  const stop = $effect.root(() => {
    $effect.pre(() => {
      turn();
      if (later && !due) return untrack(() => later(again));
      due = false;
      return run();
    });
  });
  onCleanup(stop);
  return stop;
}

/** A value that follows from others. */
export function computed<T>(work: () => T): () => T {
  const value = $derived.by(work);
  return () => value;
}

/** Undo something when the scope, effect or component in which this is called ends. */
export function onCleanup(cleanup: Cleanup): void {
  try {
    $effect.pre(() => cleanup);
  } catch {
    // nothing that could end is around it
  }
}

/** Run work; the function given back undoes every effect and cleanup that was made in it. */
export function scope(work: () => void): Cleanup {
  return $effect.root(work);
}

/** Make a function that follows `source` and reads nothing else that it would follow. */
export function on<T>(source: () => unknown, work: () => T): () => T {
  return () => {
    source();
    return untrack(work);
  };
}

/** Read signals without following them. */
export { untrack as untracked };
