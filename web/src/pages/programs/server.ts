/** The server as the parts of the page use it. */

import { call } from "../../net";
import type { ProgramRows } from "../../net/messages";
import { signal, tell } from "../../ui";
import type { ProgramServer } from "./book";

/** The real server. */
export const SERVER: ProgramServer = {
  check: (text) => call("program.check", { text }),
  save: (program, text, revision) => call("program.save", { program, text, revision }),
};

const held = signal<ProgramRows | null>(null);

/** Everything there is to begin with; null until the server has answered. */
export function rows(): ProgramRows | null {
  return held();
}

/** Ask again for what there is. */
export function refreshRows(): void {
  call("program.list", {}).then(held.set, tell);
}

/** The buttons whose forces can be taken, to choose from. */
export function bases(): readonly (readonly [string, string])[] {
  return (rows()?.bases ?? ["builtin:mx-clear"]).map((id) => [id, id.slice(id.indexOf(":") + 1)] as const);
}
