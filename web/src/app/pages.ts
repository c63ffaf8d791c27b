/** The pages of the studio. */

import type { Entry } from "./types";

/** Every page; those that keys lead to in the order of the line of work. */
export const PAGES: readonly Entry[] = [
  {
    name: "home",
    label: "Home",
    hint: "What to begin with, and recent work",
    load: () => import("../pages/home"),
  },
  {
    name: "library",
    label: "Compare",
    hint: "Find and compare buttons",
    load: () => import("../pages/library"),
  },
  { name: "edit", label: "Edit", hint: "Draw curves and vibrations", load: () => import("../pages/edit") },
  { name: "press", label: "Press", hint: "Press a button, simulated", load: () => import("../pages/press") },
  {
    name: "live",
    label: "Rig",
    hint: "Capture, compensate, tune, devices",
    load: () => import("../pages/live"),
  },
  {
    name: "optimize",
    label: "Optimise",
    hint: "Find the button you play best with",
    extra: true,
    load: () => import("../pages/optimize"),
  },
  {
    name: "studies",
    label: "Study",
    hint: "Compare buttons blind, with participants",
    extra: true,
    load: () => import("../pages/studies"),
  },
  {
    name: "programs",
    label: "Programs",
    hint: "Buttons with several states",
    load: () => import("../pages/programs"),
  },
  {
    name: "study",
    label: "Participant",
    hint: "The participant's screen",
    alone: true,
    load: () => import("../pages/study"),
  },
];

/** Every page that a key leads to: Alt with its place, 0 for the first. */
export const LISTED: readonly Entry[] = PAGES.filter((entry) => !entry.alone);
