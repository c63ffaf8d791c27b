/** Optimise: play a task with one design after the other, and find the button that one plays best with. */

import type { Page } from "../app/types";
import { h } from "../ui";
import { runList } from "./optimize/list";
import { runPage } from "./optimize/run";
import "./optimize/optimize.css";

export const page: Page = {
  title: "Optimise",
  mount(host, route) {
    const place = h("div", { class: "opt-page" });
    host.append(place);
    const run = Number(route.id);
    if (route.id && Number.isInteger(run)) runPage(place, run);
    else runList(place);
  },
};
