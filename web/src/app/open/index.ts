/** The header's part that opens files. */

import { mount } from "svelte";
import { h } from "../../ui/element";
import { batch } from "../../ui/signal.svelte";
import OpenFiles from "./OpenFiles.svelte";

export function openFiles(): HTMLElement {
  // a component may not be interrupted while it is made: what it changes is followed when it stands
  return h("span", { ref: (target) => batch(() => mount(OpenFiles, { target })) });
}
