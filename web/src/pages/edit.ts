/** The page on which a designer edits a button. */

import { mount, unmount } from "svelte";
import type { Page } from "../app/types";
import { onCleanup } from "../ui";
import EditPage from "./edit/EditPage.svelte";
import "./edit/edit.css";

export const page: Page = {
  title: "Edit",
  mount(target, { id }) {
    target.classList.add("edit-page");
    const made = mount(EditPage, { target, props: { id } });
    onCleanup(() => {
      target.classList.remove("edit-page");
      void unmount(made);
    });
  },
};
