/** The moving cue as a plot: its path comes towards a dot that only goes up and down, as the cap should. */

import { type Brush, Plot, palette, series, type View } from "../../draw";
import { signal } from "../../ui";
import { countIn, depthAt } from "./motion";

export interface Cue {
  readonly travel_mm: number;
  readonly contact_s: number;
  readonly stroke_s: number;
  readonly length_s: number;
}

export class CuePlot {
  /** What is counted before contact; empty from contact on. */
  readonly count = signal("");
  private readonly plot: Plot;
  private since_ms: number | null = null;
  private frame = 0;

  constructor(private readonly cue: Cue) {
    const wide_s = Math.min(6, Math.max(0.8, 6 * cue.stroke_s));
    this.plot = new Plot({
      label: "The cue to follow: height of the cap over time",
      x: { label: "time from now", unit: "s" },
      y: { label: "height of the cap", unit: "mm" },
      whole: () => ({
        x: { low: -0.25 * wide_s, high: 0.75 * wide_s },
        y: { low: -1.15 * cue.travel_mm, high: 0.15 * cue.travel_mm },
      }),
      moving: (brush, view) => this.draw(brush, view),
      height_px: 240,
    });
  }

  get element(): HTMLElement {
    return this.plot.element;
  }

  begin(): void {
    this.end();
    this.since_ms = performance.now();
    this.step();
  }

  end(): void {
    cancelAnimationFrame(this.frame);
  }

  private step(): void {
    this.count.set(countIn(this.time_s, this.cue.contact_s));
    this.plot.move();
    if (this.time_s < this.cue.length_s) this.frame = requestAnimationFrame(() => this.step());
    else this.since_ms = null;
  }

  private get time_s(): number {
    return this.since_ms === null ? 0 : (performance.now() - this.since_ms) / 1000;
  }

  private height_mm(t_s: number): number {
    return -this.cue.travel_mm * depthAt(t_s - this.cue.contact_s, this.cue.stroke_s);
  }

  private draw(brush: Brush, view: View): void {
    const now_s = this.time_s;
    const count = Math.round(view.box.width / 2);
    const { low, high } = view.x.range;
    const ahead = Array.from({ length: count }, (_, i) => low + ((high - low) * i) / (count - 1));
    brush.line(
      ahead.map((t) => view.x.px(t)),
      ahead.map((t) => view.y.px(this.height_mm(now_s + t))),
      { colour: series(0).colour, width_px: 3, opacity: 0.55 },
    );
    this.drawMoments(brush, view, now_s);
    const { accent, surface } = palette();
    const at = { x_px: view.x.px(0), y_px: view.y.px(this.height_mm(now_s)) };
    brush.circle(at, 11, { colour: accent }, { colour: surface, width_px: 2 });
  }

  private drawMoments(brush: Brush, view: View, now_s: number): void {
    const { muted, surface } = palette();
    const { top, height } = view.box;
    const { contact_s, stroke_s } = this.cue;
    for (const [t_s, name, y_px] of [
      [contact_s, "contact", top + 8],
      [contact_s + stroke_s, "bottom", top + height - 10],
    ] as const) {
      const x = view.x.px(t_s - now_s);
      brush.line([x, x], [top, top + height], { colour: muted, dash: [3, 3] });
      brush.text(name, { x_px: x + 4, y_px }, { colour: muted, size_px: 11, halo: surface });
    }
  }
}
