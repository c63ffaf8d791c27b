/** What the page shows while no button is chosen. */

import { address } from "../../app/route";
import { empty, h } from "../../ui";

const FIRST = ["mx-clear", "mx-brown", "mx-blue", "mx-red", "rubber-dome"] as const;

/** Where to begin. */
export function chooseButton(): HTMLElement {
  const links = FIRST.map((name) => h("a", { class: "button", href: address("edit", `builtin:${name}`) }, name));
  return empty(
    "No button chosen",
    "Begin with one of these, or find another in the library.",
    ...links,
    h("a", { class: "button main", href: address("library") }, "Library"),
  );
}
