/** Live work: not there yet. */

import type { Page } from "../app/page";
import { empty, h } from "../ui";

export const page: Page = {
  title: "Live work",
  mount(host) {
    host.append(h("h1", {}, "Live work"), empty("Not there yet", "This page is being built."));
  },
};
