/** The axes of the surface view: a floor with its grid, and along its front edges the units. */

import { type Brush, palette, tickStep, ticks, tickText } from "../../draw";
import { perUnit, unitText } from "../../ui/force";
import { type Corner, frontEdges, type Seen, type Turn } from "./surface_scene";

/** The ranges of the box. */
interface Ranges {
  readonly travel_mm: number;
  readonly velocity_mm_s: readonly [number, number];
  readonly force_cN: readonly [number, number];
}

const COUNT = 5;
const OUT = 1.14;
const FAR = 1.36;
const BELOW_px = 20;
/** A letter of a label is hardly wider. */
const LETTER_px = 7.4;
/** Half the height of a label. */
const HALF_px = 9;

/** Paint floor, ticks and labels; `at` gives where a corner of the box is seen. */
export function paintAxes(
  brush: Brush,
  at: (corner: Corner) => Seen,
  turn: Turn,
  ranges: Ranges,
  width_px: number,
): void {
  const { displacementAtBack: back, velocityAtRight: right } = frontEdges(turn);
  const axes = [
    {
      label: "displacement, mm",
      low: 0,
      high: ranges.travel_mm,
      position: (t: number, out: number): Corner => [t, back * out, -1],
      over: (t: number): Corner => [t, -back, -1],
    },
    {
      label: "velocity, mm/s",
      low: ranges.velocity_mm_s[0],
      high: ranges.velocity_mm_s[1],
      position: (t: number, out: number): Corner => [right * out, t, -1],
      over: (t: number): Corner => [-right, t, -1],
    },
    {
      label: `force, ${unitText("cN")}`,
      per: perUnit("cN"),
      low: ranges.force_cN[0],
      high: ranges.force_cN[1],
      position: (t: number, out: number): Corner => [-right * out, back * out, t],
      over: (t: number): Corner => [-right, -back, t],
    },
  ];
  const { grid, muted, text } = palette();
  for (const { label, low, high, per = 1, position, over } of axes) {
    const range = { low: low * per, high: high * per };
    for (const value of ticks(range, COUNT)) {
      const t = (2 * (value / per - low)) / (high - low || 1) - 1;
      line(brush, at(position(t, 1)), at(over(t)), grid);
      const { x, y } = at(position(t, OUT));
      brush.text(
        tickText(value, tickStep(range, COUNT)),
        { x_px: x, y_px: y },
        { colour: muted, size_px: 11, align: "center" },
      );
    }
    line(brush, at(position(-1, 1)), at(position(1, 1)), muted);
    const up = label.startsWith("force");
    const { x, y } = at(position(0, FAR));
    const [first, last] = [at(position(-1, 1)).x, at(position(1, 1)).x];
    const align = up ? "center" : x < (first + last) / 2 + 1 ? "right" : "left";
    brush.text(
      label,
      {
        x_px: up
          ? Math.min(width_px - HALF_px, Math.max(HALF_px, x - BELOW_px))
          : inside(x, align === "right", label, width_px),
        y_px: up ? y : y + BELOW_px,
      },
      { colour: text, size_px: 12, align, upwards: up },
    );
  }
}

/** Move a label along its edge until all of it is seen. */
function inside(x_px: number, endsHere: boolean, label: string, width_px: number): number {
  const long_px = LETTER_px * label.length;
  return endsHere ? Math.max(x_px, long_px) : Math.min(x_px, width_px - long_px);
}

function line(brush: Brush, a: Seen, b: Seen, colour: string): void {
  brush.line([a.x, b.x], [a.y, b.y], { colour });
}
