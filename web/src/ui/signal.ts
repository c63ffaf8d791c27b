/** Values that tell who uses them when they change. */

/** What must be undone when a page, or a part of it, goes. */
export type Cleanup = () => void;

interface Watcher {
  readonly sources: Set<Set<Watcher>>;
  run: () => void;
}

export interface Signal<T> {
  /** Return the value; an effect or computed value that reads it runs again when it changes. */
  (): T;
  set(value: T): void;
  update(change: (value: T) => T): void;
  /** Return the value without following it. */
  peek(): T;
}

let watching: Watcher | null = null;
let cleanups: Cleanup[] | null = null;
let depth = 0;
let flushing = false;
const waiting = new Set<Watcher>();

function follow(watchers: Set<Watcher>): void {
  if (!watching) return;
  watchers.add(watching);
  watching.sources.add(watchers);
}

/** Run who waits; what they change waits for the next round, so that nothing runs inside itself. */
function flush(): void {
  if (flushing || depth > 0) return;
  flushing = true;
  const thrown: unknown[] = [];
  for (let rounds = 0; waiting.size; rounds++) {
    const now = [...waiting];
    waiting.clear();
    if (rounds > 100) thrown.push(new Error("signals update each other endlessly"));
    else for (const watcher of now) attempt(watcher, thrown);
  }
  flushing = false;
  if (thrown.length) throw thrown[0];
}

/** One that fails must not keep the others from what changed. */
function attempt(watcher: Watcher, thrown: unknown[]): void {
  try {
    watcher.run();
  } catch (error) {
    thrown.push(error);
  }
}

/** Make changes together: who follows several of them runs once. */
export function batch(changes: () => void): void {
  depth++;
  try {
    changes();
  } finally {
    depth--;
    flush();
  }
}

export function signal<T>(initial: T): Signal<T> {
  let value = initial;
  const watchers = new Set<Watcher>();
  const read = (() => {
    follow(watchers);
    return value;
  }) as Signal<T>;
  read.peek = () => value;
  read.set = (next) => {
    if (Object.is(next, value)) return;
    value = next;
    for (const watcher of watchers) waiting.add(watcher);
    flush();
  };
  read.update = (change) => read.set(change(value));
  return read;
}

function forget(watcher: Watcher): void {
  for (const watchers of watcher.sources) watchers.delete(watcher);
  watcher.sources.clear();
}

/**
 * Run now, and again whenever a signal that was read changes; ends with its scope, or when called.
 *
 * later: given the next run to do when it suits, such as with the next frame; at once if it is left out.
 */
export function effect(work: () => void | Cleanup, later?: (run: () => void) => void): Cleanup {
  let undo: Cleanup = () => undefined;
  let over = false;
  const watcher: Watcher = {
    sources: new Set(),
    run() {
      if (over) return;
      undo();
      forget(watcher);
      const [outer, outside] = [watching, cleanups];
      const own: Cleanup[] = [];
      watching = watcher;
      cleanups = own;
      try {
        const last = work();
        if (last) own.push(last);
      } finally {
        watching = outer;
        cleanups = outside;
        undo = () => ended(own);
      }
    },
  };
  watcher.run();
  if (later) {
    const now = watcher.run;
    watcher.run = () => later(now);
  }
  const stop = () => {
    over = true;
    waiting.delete(watcher);
    forget(watcher);
    undo();
    undo = () => undefined;
  };
  onCleanup(stop);
  return stop;
}

/** A value that follows from others; computed anew at most once for each change of them. */
export function computed<T>(work: () => T): () => T {
  const value = signal<T>(undefined as T);
  effect(() => value.set(work()));
  return () => value();
}

function ended(list: Cleanup[]): void {
  for (const cleanup of list.splice(0).reverse()) cleanup();
}

/** Undo something when the scope, or effect, in which this is called ends. */
export function onCleanup(cleanup: Cleanup): void {
  cleanups?.push(cleanup);
}

/** Run work; the function given back undoes every effect and cleanup that was made in it. */
export function scope(work: () => void): Cleanup {
  const [outer, outside] = [watching, cleanups];
  const own: Cleanup[] = [];
  watching = null;
  cleanups = own;
  try {
    work();
  } finally {
    watching = outer;
    cleanups = outside;
  }
  return () => ended(own);
}

/** Make a function that follows `source` and reads nothing else that it would follow. */
export function on<T>(source: () => unknown, work: () => T): () => T {
  return () => {
    source();
    return untracked(work);
  };
}

/** Read signals without following them. */
export function untracked<T>(work: () => T): T {
  const outer = watching;
  watching = null;
  try {
    return work();
  } finally {
    watching = outer;
  }
}
