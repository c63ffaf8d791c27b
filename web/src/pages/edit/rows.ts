/** Lists and tables whose rows follow signals. */

import { effect } from "../../ui";

/** Make an element's children follow a signal; unlike a slot this puts nothing between a list and its items. */
export function filled<E extends HTMLElement>(element: E, rows: () => readonly Node[]): E {
  effect(() => element.replaceChildren(...rows()));
  return element;
}
