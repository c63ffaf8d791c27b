/** The pages that this installation lacks. */

import { call } from "../net/call";
import { type Signal, signal } from "../ui/signal.svelte";

const packages: Signal<ReadonlyMap<string, string>> = signal(new Map());
let asked: Promise<void> | undefined;

/** Ask the studio once; of one that does not answer every page counts as there. */
export function askAbsent(): Promise<void> {
  asked ??= call("studio.about", {}).then(
    ({ absent }) => {
      packages.set(
        new Map(Object.entries(absent).flatMap(([name, pages]) => pages.map((page) => [page, name]))),
      );
    },
    () => undefined,
  );
  return asked;
}

/** Return the package that would bring a page; empty for a page that is there. */
export function packageOf(page: string): string {
  return packages().get(page) ?? "";
}
