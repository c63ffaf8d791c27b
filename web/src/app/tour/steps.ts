/** The steps of the tour: from a measured button to one that was edited and pressed. */

import { current } from "../current";
import { address } from "../route";

export interface TourStep {
  /** The page it is on, and its address. */
  readonly page: string;
  readonly at: () => string;
  /** What it points at, as a selector. */
  readonly element: string;
  readonly title: string;
  readonly text: string;
}

export const BUTTON = "builtin:mx-clear";
const library = { page: "library", at: () => address("library", "", { over: BUTTON }) };
/** The copy, once the first edit has made one. */
const mine = () => (current.peek().startsWith("own:") ? current.peek() : BUTTON);
const edit = { page: "edit", at: () => address("edit", mine()) };

export const STEPS: readonly TourStep[] = [
  {
    ...library,
    element: ".lib-plot",
    title: "How a button feels",
    text: "Force over displacement of a Cherry MX Clear. The force rises to a peak, falls, and rises again: a finger feels that bump. Solid is the press, dashed the release.",
  },
  {
    ...library,
    element: ".lib-below",
    title: "Its landmarks",
    text: "Peak, bump, actuation, travel. Choose more buttons in the list to see how they differ.",
  },
  {
    ...edit,
    element: ".edit-canvas",
    title: "Change it",
    text: "Drag a round point up or down. By keys: C goes to the curve, Right chooses a point, Up raises it.",
  },
  {
    ...edit,
    element: ".edit-verdict",
    title: "Can a rig render it?",
    text: "The line below the curve says what the chosen rig can follow, computed while you drag.",
  },
  {
    ...edit,
    element: "header .menu-name",
    title: "It is your own now",
    text: "The first change made a copy of your own. Rename it here; every step of the work goes on with it.",
  },
  {
    page: "press",
    at: () => address("press", mine()),
    element: "main[data-page=press] [role=application]",
    title: "Press it",
    text: "Hold the Space bar, or the mouse on the cap. You press a simulated rig with your button on it.",
  },
  {
    page: "press",
    at: () => address("press", mine()),
    element: "header nav",
    title: "The line of work",
    text: "Go on from left to right: on a rig, by optimisation, in a study with participants.",
  },
];
