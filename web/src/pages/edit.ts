/** The page on which a designer edits a button. */

import type { Page } from "../app/types";
import { h, onCleanup, scope, tell } from "../ui";
import { chooseButton } from "./edit/choose";
import { EditorController } from "./edit/editor_controller";
import { followButton, openButton } from "./edit/opening";
import { workbench } from "./edit/workbench";
import "./edit/edit.css";

export const page: Page = {
  title: "Edit",
  mount(host, { id }) {
    host.classList.add("edit-page");
    onCleanup(() => host.classList.remove("edit-page"));
    if (!id) return host.append(chooseButton());
    const waiting = h("p", { class: "muted", role: "status" }, "Opening the button…");
    host.append(waiting);
    let [left, leave] = [false, () => {}];
    onCleanup(() => {
      left = true;
      leave();
    });
    openButton(id).then(
      (opened) => {
        if (left) return opened.store.close();
        leave = scope(() => {
          followButton(opened);
          host.replaceChildren(workbench(new EditorController(opened.store), opened.button));
        });
      },
      (error) => {
        if (!left) host.replaceChildren(chooseButton());
        tell(error);
      },
    );
  },
};
