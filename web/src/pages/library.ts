/** The library: buttons to find and compare. */

import type { Page } from "../app/page";
import { Plot } from "../draw";
import { call } from "../net";
import { empty, h, panel, signal, tell, toolbar, button } from "../ui";

export const page: Page = {
  title: "Library",
  mount(host) {
    const said = signal("…");
    call("studio.about", {}).then((about) => said.set(`${about.project}, fdvv ${about.version}`), tell);
    const plot = new Plot({
      label: "Force over displacement",
      x: { label: "displacement", unit: "mm" },
      y: { label: "force", unit: "cN" },
      whole: () => ({ x: { low: 0, high: 4 }, y: { low: 0, high: 80 } }),
      zoom: true,
      height_px: 300,
    });
    host.append(
      h("h1", {}, "Library"),
      toolbar("View", button({ label: "Fit", act: () => plot.fit() })),
      panel("Curves", plot.element),
      empty("Nothing chosen", "Choose a button to see its curves."),
      h("p", { class: "muted" }, said),
    );
  },
};
