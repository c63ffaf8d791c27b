/** The parts of the editor, side by side: curves, canvas, numbers. */

import { controlPoints_mm } from "../../math";
import { type Cleanup, effect, h, scope, signal, tabs, tell, untracked } from "../../ui";
import { assignPanels } from "./assign_panel";
import { bar } from "./bar";
import { editorCanvas } from "./canvas";
import { curvesPanel } from "./curves_panel";
import type { EditorController } from "./editor_controller";
import { figuresPanel } from "./figures_panel";
import { historyPanels } from "./history_panel";
import { listenForKeys } from "./keys";
import { PointerController } from "./pointer_controller";
import { limitsPanel, pointsPanels } from "./points_panel";
import { lookAtRigs } from "./rigs";
import { positionSliders } from "./sliders";
import { verdictStrip } from "./verdict";
import { vibrationPanels } from "./vibration_panel";

type Panels = (editor: EditorController) => HTMLElement[];
type Tab = "points" | "figures" | "assign" | "vibration" | "surface" | "history";

interface Part {
  readonly label: string;
  readonly load: () => Panels | Promise<Panels>;
}

const PARTS: Readonly<Record<Tab, Part>> = {
  points: { label: "Points", load: () => pointsPanels },
  figures: { label: "Figures", load: () => (editor) => [figuresPanel(editor)] },
  assign: { label: "Assign", load: () => assignPanels },
  vibration: { label: "Vibration", load: () => vibrationPanels },
  // a chunk of its own: who only draws curves need not wait for its painter
  surface: { label: "Surface", load: () => import("./surface_view").then((found) => found.surfacePanels) },
  history: { label: "Steps", load: () => historyPanels },
};

/** The whole editor for one button. */
export function workbench(editor: EditorController, id: () => string): HTMLElement {
  const rig = lookAtRigs(editor, id);
  const canvas = editorCanvas(editor, rig);
  const pointer = new PointerController(editor, canvas);
  listenForKeys(editor, canvas, pointer);
  canvas.plot.element.after(...positionSliders(editor, canvas));
  return h(
    "div",
    { class: "edit" },
    bar(editor, canvas.plot, id),
    h("div", { class: "edit-left" }, curvesPanel(editor), limitsPanel(editor)),
    h(
      "div",
      { class: "edit-middle panel" },
      canvas.element,
      verdictStrip(editor, rig),
      selectionStatus(editor),
    ),
    side(editor),
  );
}

/** The tabs at the side; what belongs to a tab is made when it is shown, and goes with it. */
function side(editor: EditorController): HTMLElement {
  const tab = signal<Tab>("points");
  const content = h("div", {
    class: "edit-side stack",
    role: "tabpanel",
    "aria-label": () => PARTS[tab()].label,
  });
  effect(() => fill(content, editor, PARTS[tab()]));
  const entries = Object.entries(PARTS).map(([name, part]) => [name as Tab, part.label] as const);
  return h(
    "div",
    { class: "edit-right" },
    tabs({ label: "Parts of the button", tabs: entries, value: () => tab(), set: (to) => tab.set(to) }),
    content,
  );
}

/** Show a part; the function given back takes it away. */
function fill(content: HTMLElement, editor: EditorController, part: Part): Cleanup {
  let [left, leave]: [boolean, Cleanup] = [false, () => undefined];
  const show = (panels: Panels) => {
    if (!left) leave = scope(() => untracked(() => content.replaceChildren(...panels(editor))));
  };
  const loaded = part.load();
  if (loaded instanceof Promise) loaded.then(show, tell);
  else show(loaded);
  return () => {
    left = true;
    leave();
  };
}

/** A line that screen readers read out when the selection changes, or what is selected comes to rest elsewhere. */
function selectionStatus(editor: EditorController): HTMLElement {
  const line = () => {
    editor.settled();
    const [first, ...more] = editor.selection();
    if (first === undefined) return "";
    if (more.length) return `${more.length + 1} points selected`;
    const curve = editor.curve();
    const [x_mm, force_cN] = [controlPoints_mm(curve)[first], curve.control_points_cN[first]];
    if (x_mm === undefined || force_cN === undefined) return "";
    return `point ${first + 1} of ${curve.control_points_cN.length}, ${x_mm.toFixed(2)} mm, ${force_cN.toFixed(1)} cN`;
  };
  return h("div", { class: "visually-hidden", role: "status", "aria-live": "polite" }, line);
}
