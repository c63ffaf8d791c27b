/** The open program of the page that a component stands in. */

import { createContext } from "svelte";
import type { Signal } from "../../ui";
import type { ProgramBook } from "./book";
import type { ForcePlots } from "./forces";
import type { GraphHand } from "./graph_hand";

export interface OpenProgram {
  readonly book: ProgramBook;
  readonly graph: GraphHand;
  readonly forces: ForcePlots;
  /** The state in which a press is just now, or null. */
  readonly live: Signal<string | null>;
}

export const [programHere, provideProgram] = createContext<OpenProgram>();
