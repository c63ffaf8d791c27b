/** Edit: not there yet. */

import type { Page } from "../app/page";
import { empty, h } from "../ui";

export const page: Page = {
  title: "Edit",
  mount(host) {
    host.append(h("h1", {}, "Edit"), empty("Not there yet", "This page is being built."));
  },
};
