/** The bar above the editor: which button, what is saved, back and forth, what to take away. */

import type { Plot } from "../../draw";
import { button, h, toggle, toolbar } from "../../ui";
import type { Desk } from "./desk";
import { exportMenu } from "./exports";
import { pin } from "./history_panel";
import { buttonMenu } from "./menu";
import { savedWord, savingStrip } from "./saving";

/** The bar. */
export function bar(desk: Desk, plot: Plot, id: () => string): HTMLElement {
  const { store } = desk;
  const told = (what: string, label: string | null) => (label === null ? what : `${what}: ${label}`);
  return h(
    "div",
    { class: "edit-bar" },
    h("h1", {}, () => desk.settled().name),
    h("span", { class: "tag" }, () => kindOf(id())),
    () => (desk.settled().provenance.simulated ? h("span", { class: "tag simulated" }, "simulated") : null),
    savedWord(desk),
    savingStrip(desk),
    h("span", { class: "grow" }),
    toolbar(
      "Edit",
      h(
        "button",
        { type: "button", class: "button glyph", "aria-label": () => (desk.turns(), told("Undo", store.history.undoLabel)), title: () => (desk.turns(), told("Undo", store.history.undoLabel)), disabled: () => (desk.turns(), !store.history.canUndo), on: { click: () => desk.step(-1) } },
        "↶",
      ),
      h(
        "button",
        { type: "button", class: "button glyph", "aria-label": () => (desk.turns(), told("Redo", store.history.redoLabel)), title: () => (desk.turns(), told("Redo", store.history.redoLabel)), disabled: () => (desk.turns(), !store.history.canRedo), on: { click: () => desk.step(1) } },
        "↷",
      ),
      toggle({ label: "Before", value: () => desk.showBefore(), set: (on) => desk.showBefore.set(on), hint: "Show the state that is compared with (B)" }),
      button({ label: "Pin", act: () => pin(desk), hint: "Compare with the present state from now on (P)" }),
      button({ label: "Zoom in", glyph: "+", act: () => plot.zoomBy(0.8) }),
      button({ label: "Zoom out", glyph: "−", act: () => plot.zoomBy(1.25) }),
      button({ label: "Fit", act: () => plot.fit(), hint: "See everything (F)" }),
      buttonMenu(desk, id),
      exportMenu(desk, plot),
    ),
  );
}

/** Where a button comes from, in words. */
function kindOf(id: string): string {
  const kind = id.slice(0, id.indexOf(":"));
  return kind === "own" ? "own" : `${kind}; a change makes a copy of your own`;
}
