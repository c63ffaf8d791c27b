/** What a page is: a module that fills its place, and undoes it by the scope it is mounted in. */

import type { Route } from "./route";

export interface Page {
  /** Of the browser's tab and the page's heading. */
  readonly title: string;
  /** Fill the host; runs in a scope, so effects and cleanups end when the page goes. */
  mount(host: HTMLElement, route: Route): void;
  /** Whether the page itself follows another id or query; else it is mounted anew. */
  readonly followsRoute?: boolean;
}

export interface Entry {
  readonly name: string;
  readonly label: string;
  /** Said under the label's place where there is room. */
  readonly hint: string;
  /** Reached by its address only, with nothing of the studio around it: no navigation, no keys that lead away. */
  readonly alone?: boolean;
  readonly load: () => Promise<{ readonly page: Page }>;
}

/** Every page, in the order of the navigation. */
export const PAGES: readonly Entry[] = [
  { name: "library", label: "Library", hint: "Find and compare buttons", load: () => import("../pages/library") },
  { name: "edit", label: "Edit", hint: "Draw curves and vibrations", load: () => import("../pages/edit") },
  { name: "press", label: "Press", hint: "Press a button, simulated", load: () => import("../pages/press") },
  { name: "live", label: "Live work", hint: "Capture, compensate, tune, devices", load: () => import("../pages/live") },
  { name: "programs", label: "Programs", hint: "Buttons of several states", load: () => import("../pages/programs") },
  { name: "optimize", label: "Optimise", hint: "Find the button you play best with", load: () => import("../pages/optimize") },
  { name: "studies", label: "Studies", hint: "Compare buttons blind, with people", load: () => import("../pages/studies") },
  { name: "study", label: "Study", hint: "The participant's screen", alone: true, load: () => import("../pages/study") },
];

/** Every page that the navigation leads to. */
export const LISTED: readonly Entry[] = PAGES.filter((entry) => !entry.alone);
