/** Press: feel a button under a simulated finger. */

import { mount, unmount } from "svelte";
import type { Page } from "../app/types";
import { onCleanup } from "../ui";
import PressPage from "./press/PressPage.svelte";

export const page: Page = {
  title: "Press",
  mount(target, route) {
    const made = mount(PressPage, { target, props: { route } });
    onCleanup(() => void unmount(made));
  },
};
