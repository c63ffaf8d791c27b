/** Press: not there yet. */

import type { Page } from "../app/page";
import { empty, h } from "../ui";

export const page: Page = {
  title: "Press",
  mount(host) {
    host.append(h("h1", {}, "Press"), empty("Not there yet", "This page is being built."));
  },
};
