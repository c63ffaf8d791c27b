/** Programs: not there yet. */

import type { Page } from "../app/page";
import { empty, h } from "../ui";

export const page: Page = {
  title: "Programs",
  mount(host) {
    host.append(h("h1", {}, "Programs"), empty("Not there yet", "This page is being built."));
  },
};
