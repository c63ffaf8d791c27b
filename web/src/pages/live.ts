/** The rig: capture, compensate, tune, devices; with all jobs always in view. */

import { mount, unmount } from "svelte";
import type { Page } from "../app/types";
import { onCleanup } from "../ui";
import LivePage from "./live/LivePage.svelte";
import "./live/live.css";

export const page: Page = {
  title: "Rig",
  followsRoute: true,
  mount(target) {
    const made = mount(LivePage, { target });
    onCleanup(() => void unmount(made));
  },
};
