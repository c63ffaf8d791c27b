/** The last press on the connected device: force over displacement beside what its button asks for. */

import { type Brush, type PlotOptions, palette, RELEASE_DASH, rangeOf, series, type View } from "../../draw";
import { seen, standing } from "./looking";

export const lastPress: PlotOptions = {
  label: "Force over displacement of the last press",
  x: { label: "displacement", unit: "mm" },
  y: { label: "force", unit: "cN" },
  whole: () => {
    const press = seen();
    const columns = press ? curves(press).map(([cN]) => cN.map((v) => v ?? NaN)) : [];
    const y = rangeOf(columns, 0.1) ?? { low: 0, high: 100 };
    return {
      x: { low: 0, high: press?.displacement_mm.at(-1) ?? standing().travel_mm ?? 4 },
      y: { low: Math.min(0, y.low), high: y.high },
    };
  },
  still: draw,
  height_px: 260,
};

type Seen = NonNullable<ReturnType<typeof seen>>;

/** The curves with their colour, release after press. */
function curves(press: Seen): readonly (readonly [readonly (number | null)[], string])[] {
  const [target, rendered] = [palette().text, series(1).colour];
  return [
    [press.intended_press_cN, target],
    [press.intended_release_cN, target],
    [press.felt_press_cN, rendered],
    [press.felt_release_cN, rendered],
  ];
}

function draw(brush: Brush, view: View): void {
  const press = seen();
  if (!press) return;
  const x = press.displacement_mm.map((mm) => view.x.px(mm));
  curves(press).forEach(([cN, colour], i) => {
    const y = cN.map((v) => (v === null ? NaN : view.y.px(v)));
    brush.line(x, y, { colour, width_px: i < 2 ? 1.2 : 2, ...(i % 2 && { dash: RELEASE_DASH }) });
  });
}
