/** What a page found, in one sentence, and the one thing to do next: shown below every page, in the same place. */

import { effect, onCleanup, type Signal, signal } from "../ui/signal.svelte";

export interface Step {
  readonly label: string;
  /** Where it leads, as `address` writes it. */
  readonly to?: string;
  /** What it does, where it leads nowhere. */
  readonly act?: () => void;
}

export interface Verdict {
  readonly sentence: string;
  readonly kind?: "good" | "warning";
  readonly next?: Step;
}

export const verdict: Signal<Verdict | null> = signal<Verdict | null>(null);

/** Show a verdict until the component or scope in which this is called ends; `of` may read signals. */
export function conclude(of: () => Verdict | null): void {
  let mine: Verdict | null = null;
  effect(() => {
    mine = of();
    verdict.set(mine);
  });
  // the next page may have said its own before this one ends
  onCleanup(() => verdict.peek() === mine && verdict.set(null));
}
