/** What fields offer to choose from, and begin with. */

import type { Signal } from "../../programs/document";

/** A signal as it is at first. */
export const CLICK: Signal & { modes: readonly [Signal["modes"][number]] } = {
  name: "click",
  duration_s: 0.012,
  modes: [{ frequency_Hz: 200, amplitude_m_s2: 6, decay_1_s: 250 }],
};

/** Return the parts of a program to choose from, by name; `none` is offered first if it has words. */
export function named(
  parts: readonly { readonly name: string }[] = [],
  none?: string,
): (readonly [string, string])[] {
  const names = parts.map(({ name }) => [name, name] as const);
  return none === undefined ? names : [["", none], ...names];
}
