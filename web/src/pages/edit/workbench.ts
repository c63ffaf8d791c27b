/** The parts of the editor, side by side: curves, canvas, numbers. */

import { type Cleanup, effect, h, scope, signal, tabs, tell, untracked } from "../../ui";
import { assignPanels } from "./assign_panel";
import { bar } from "./bar";
import { editorCanvas } from "./canvas";
import { curvesPanel } from "./curves_panel";
import type { Desk } from "./desk";
import { figuresPanel } from "./figures_panel";
import { Hand } from "./hand";
import { historyPanels } from "./history_panel";
import { listenForKeys } from "./keys";
import { limitsPanel, pointsPanels } from "./points_panel";
import { selectionSaid } from "./selection_said";
import { lookAtRigs } from "./rigs";
import { placeSliders } from "./sliders";
import { verdictStrip } from "./verdict";
import { vibrationPanels } from "./vibration_panel";

type Panels = (desk: Desk) => HTMLElement[];
type Tab = "points" | "figures" | "assign" | "vibration" | "surface" | "history";

interface Part {
  readonly label: string;
  readonly load: () => Panels | Promise<Panels>;
}

const PARTS: Readonly<Record<Tab, Part>> = {
  points: { label: "Points", load: () => pointsPanels },
  figures: { label: "Figures", load: () => (desk) => [figuresPanel(desk)] },
  assign: { label: "Assign", load: () => assignPanels },
  vibration: { label: "Vibration", load: () => vibrationPanels },
  // a chunk of its own: who only draws curves need not wait for its painter
  surface: { label: "Surface", load: () => import("./surface_view").then((found) => found.surfacePanels) },
  history: { label: "Steps", load: () => historyPanels },
};

/** The whole editor for one button. */
export function workbench(desk: Desk, id: () => string): HTMLElement {
  const rig = lookAtRigs(desk, id);
  const canvas = editorCanvas(desk, rig);
  const hand = new Hand(desk, canvas);
  listenForKeys(desk, canvas, hand);
  canvas.plot.element.after(...placeSliders(desk, canvas));
  return h(
    "div",
    { class: "edit" },
    bar(desk, canvas.plot, id),
    h("div", { class: "edit-left" }, curvesPanel(desk), limitsPanel(desk)),
    h("div", { class: "edit-middle panel" }, canvas.element, verdictStrip(desk, rig), selectionSaid(desk)),
    side(desk),
  );
}

/** The tabs at the side; what belongs to a tab is made when it is shown, and goes with it. */
function side(desk: Desk): HTMLElement {
  const tab = signal<Tab>("points");
  const content = h("div", { class: "edit-side stack", role: "tabpanel", "aria-label": () => PARTS[tab()].label });
  effect(() => fill(content, desk, PARTS[tab()]));
  const entries = Object.entries(PARTS).map(([name, part]) => [name as Tab, part.label] as const);
  return h("div", { class: "edit-right" }, tabs({ label: "Parts of the button", tabs: entries, value: () => tab(), set: (to) => tab.set(to) }), content);
}

/** Show a part; the function given back takes it away. */
function fill(content: HTMLElement, desk: Desk, part: Part): Cleanup {
  let [left, leave]: [boolean, Cleanup] = [false, () => undefined];
  const show = (panels: Panels) => {
    if (!left) leave = scope(() => untracked(() => content.replaceChildren(...panels(desk))));
  };
  const loaded = part.load();
  if (loaded instanceof Promise) loaded.then(show, tell);
  else show(loaded);
  return () => {
    left = true;
    leave();
  };
}
