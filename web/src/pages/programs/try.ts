/** Where a program is pressed at once. */

import { h, panel } from "../../ui";
import type { ProgramBook } from "./book";

/** The place beside the graph in which the program is pressed; `live` is told the state that the press is in. */
export function tryPanel(book: ProgramBook, live: (state: string | null) => void): HTMLElement {
  live(null);
  return panel("Try it", h("p", { class: "muted" }, () => (book.own ? "Open the Press page to press it." : "Copy it to press it.")));
}
