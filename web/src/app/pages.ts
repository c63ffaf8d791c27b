/** The pages of the studio. */

import type { Entry } from "./types";

/** Every page, in the order of the navigation. */
export const PAGES: readonly Entry[] = [
  {
    name: "library",
    label: "Library",
    hint: "Find and compare buttons",
    load: () => import("../pages/library"),
  },
  { name: "edit", label: "Edit", hint: "Draw curves and vibrations", load: () => import("../pages/edit") },
  { name: "press", label: "Press", hint: "Press a button, simulated", load: () => import("../pages/press") },
  {
    name: "live",
    label: "Live work",
    hint: "Capture, compensate, tune, devices",
    load: () => import("../pages/live"),
  },
  {
    name: "programs",
    label: "Programs",
    hint: "Buttons with several states",
    load: () => import("../pages/programs"),
  },
  {
    name: "optimize",
    label: "Optimise",
    hint: "Find the button you play best with",
    load: () => import("../pages/optimize"),
  },
  {
    name: "studies",
    label: "Studies",
    hint: "Compare buttons blind, with participants",
    load: () => import("../pages/studies"),
  },
  {
    name: "study",
    label: "Study",
    hint: "The participant's screen",
    alone: true,
    load: () => import("../pages/study"),
  },
];

/** Every page that the navigation leads to. */
export const LISTED: readonly Entry[] = PAGES.filter((entry) => !entry.alone);
