/** The last press on the connected device: force over displacement beside what its button asks for. */

import { type Brush, Plot, type Range, rangeOf, series, type View } from "../../draw";
import { h, panel } from "../../ui";
import { swatch } from "./converge";
import { seen, standing } from "./looking";

export function pressPanel(): HTMLElement {
  const plot = new Plot({
    label: "Force over displacement of the last press",
    x: { label: "displacement", unit: "mm" },
    y: { label: "force", unit: "cN" },
    whole,
    still: draw,
    height_px: 260,
  });
  const legend = h(
    "span",
    { class: "legend" },
    swatch(0, "intended"),
    swatch(1, "rendered, press"),
    swatch(2, "rendered, release"),
  );
  return panel("Last press", h("p", { class: "muted" }, said), legend, plot.element);
}

function said(): string {
  const press = seen();
  if (press)
    return `At ${press.velocity_mm_s} mm/s, rendered, in true displacement${press.simulated ? ", simulated" : ""}.`;
  return standing().programmed ? "Press once to see it here." : "Upload a button, then press it.";
}

function whole(): { x: Range; y: Range } {
  const press = seen();
  const columns = press ? [press.intended_press_cN, press.felt_press_cN.map((v) => v ?? NaN)] : [];
  const y = rangeOf(columns, 0.1) ?? { low: 0, high: 100 };
  return {
    x: { low: 0, high: press?.displacement_mm.at(-1) ?? standing().travel_mm ?? 4 },
    y: { low: Math.min(0, y.low), high: y.high },
  };
}

function draw(brush: Brush, view: View): void {
  const press = seen();
  if (!press) return;
  const x = press.displacement_mm.map((mm) => view.x.px(mm));
  const line = (values: readonly (number | null)[], n: number, opacity = 1) => {
    const { colour, dash } = series(n);
    brush.line(
      x,
      values.map((cN) => (cN === null ? NaN : view.y.px(cN))),
      { colour, dash, width_px: 2, opacity },
    );
  };
  line(press.intended_press_cN, 0);
  line(press.intended_release_cN, 0, 0.6);
  line(press.felt_press_cN, 1);
  line(press.felt_release_cN, 2);
}
