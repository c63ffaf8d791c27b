/** Studies: declare, freeze, have people sit down, see how far they are, unseal. Never what a label hides. */

import type { Page } from "../app/types";
import { h } from "../ui";
import { studyList } from "./studies/list";
import { studyPage } from "./studies/one";
import "./studies/studies.css";

export const page: Page = {
  title: "Studies",
  mount(host, route) {
    const place = h("div", { class: "sts-page" });
    host.append(place);
    if (route.id) studyPage(place, route.id);
    else studyList(place);
  },
};
