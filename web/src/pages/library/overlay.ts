/** The curves of the chosen buttons on the same axes: force, slope or work over displacement. */

import { type Brush, type EndLabel, Plot, palette, RELEASE_DASH, type Stroke, type View } from "../../draw";
import type { LibraryButton } from "../../net/messages";
import { computed, type Signal, signal } from "../../ui";
import { speedText } from "./columns";
import { type Line, lineOf, type StrokeName, seen, strokeAt, valueAt } from "./curves";
import { DISTINCT, fade, strokeOf } from "./marks";
import { SKETCH_POINTS } from "./rows";
import type { ViewName } from "./state";
import type { LibraryStore } from "./store";

export interface Drawn {
  /** Place in the overlay. */
  readonly n: number;
  readonly button: LibraryButton;
  readonly stroke: StrokeName;
  readonly velocity_mm_s: number | null;
  readonly line: Line;
}

export const AXES: Readonly<Record<ViewName, { readonly label: string; readonly unit: string }>> = {
  force: { label: "force", unit: "cN" },
  slope: { label: "slope", unit: "cN/mm" },
  work: { label: "work", unit: "mJ" },
};

const NEAR_px = 24;

export class Overlay {
  readonly plot: Plot;
  /** Where the pointer is, mm; null outside. */
  readonly cursor_mm: Signal<number | null> = signal(null);
  readonly drawn: () => readonly Drawn[];
  /** Id of the button that is pointed at, in the legend or by the pointer near its curve. */
  readonly pointed: Signal<string | null> = signal(null);
  private readonly stamp: Signal<string | null> = signal(null);

  constructor(private readonly store: LibraryStore) {
    this.drawn = computed(() => this.lines());
    const axes = () => AXES[store.shown().view];
    const y = {
      get label() {
        return axes().label;
      },
      get unit() {
        return axes().unit;
      },
    };
    this.plot = new Plot({
      label: "Curves of the chosen buttons",
      x: { label: "displacement from contact", unit: "mm" },
      y,
      whole: () => this.whole(),
      still: (brush, view) => this.paint(brush, view),
      moving: (brush, view) => this.paintCursor(brush, view),
      zoom: true,
      ends: computed(() => this.ends()),
    });
    this.plot.element.addEventListener("pointermove", (event) => {
      const at = this.plot.at(event);
      this.cursor_mm.set(at.x);
      this.pointed.set(this.nearest(at.x, at.y_px));
    });
    this.plot.element.addEventListener("pointerleave", () => {
      this.cursor_mm.set(null);
      this.pointed.set(null);
    });
  }

  /** Return the button that the keys of the list are at, if it is not chosen anyway. */
  preview(): { readonly name: string; readonly lines: readonly Line[] } | null {
    const { rows, shown } = this.store;
    const id = this.store.activeId();
    if (id === null || shown().overlay.includes(id) || shown().view !== "force") return null;
    const at = rows.at(id);
    const travel_mm = rows.number("travel_mm", at) ?? 0;
    const lines = (["press", "release"] as const).flatMap((stroke) => {
      const force_cN = rows.sketch_cN(at, stroke);
      if (!force_cN) return [];
      return [
        {
          x_mm: Float64Array.from(force_cN, (_, i) => (travel_mm * i) / (SKETCH_POINTS - 1)),
          y: Float64Array.from(force_cN),
        },
      ];
    });
    return lines.length ? { name: rows.names[at] ?? "", lines } : null;
  }

  /** Return how strongly a compared button is drawn. */
  opacity(id: string): number {
    const { overlay, reference } = this.store.shown();
    const looked_at = [this.pointed() ?? reference, this.store.activeId()].includes(id);
    return fade(overlay.length, looked_at);
  }

  /** The id of the button whose curve is nearest to a place, if it is near. */
  private nearest(x_mm: number, y_px: number): string | null {
    const { y } = this.plot.view();
    let [id, least]: [string | null, number] = [null, NEAR_px];
    for (const one of this.drawn()) {
      const off = Math.abs(y.px(valueAt(one.line, x_mm)) - y_px);
      if (off < least) [id, least] = [one.button.id, off];
    }
    return id;
  }

  /** A name for each compared button, where its press ends. */
  private ends(): EndLabel[] {
    const first = (one: Drawn, i: number, all: readonly Drawn[]) =>
      one.n < DISTINCT && i === all.findIndex((other) => other.n === one.n && other.stroke === one.stroke);
    const presses = this.drawn().filter(
      (one) => one.stroke === (this.store.shown().press ? "press" : "release"),
    );
    return presses.filter(first).map((one) => ({
      text: one.button.name,
      colour: strokeOf(one.n).colour,
      x: one.line.x_mm.at(-1) as number,
      y: one.line.y.findLast(Number.isFinite) ?? 0,
      weight: one.button.id === (this.pointed() ?? this.store.shown().reference) ? 1 : 0,
      opacity: this.opacity(one.button.id),
    }));
  }

  /** Run work while names and a line of origin stand in the plot, as files need them. */
  stamped<T>(line: string, work: () => T): T {
    this.stamp.set(line);
    try {
      return work();
    } finally {
      this.stamp.set(null);
    }
  }

  private lines(): Drawn[] {
    const { overlay, view, press, release, velocity_mm_s } = this.store.shown();
    const buttons = this.store.buttons();
    const names = (["release", "press"] as const).filter((stroke) => (stroke === "press" ? press : release));
    return overlay.flatMap((id, n) => {
      const button = buttons.get(id);
      if (!button) return [];
      return names.flatMap((stroke) => {
        const found = strokeAt(button, stroke, velocity_mm_s);
        return found
          ? [{ n, button, stroke, velocity_mm_s: found.velocity_mm_s, line: lineOf(found, view) }]
          : [];
      });
    });
  }

  private whole() {
    const preview = this.preview();
    const lines = [...this.drawn().map((one) => one.line), ...(preview?.lines ?? [])];
    const last = Math.max(0, ...lines.map((line) => line.x_mm.at(-1) as number));
    return { x: { low: -0.05, high: (last || 4) * 1.03 }, y: seen(lines, this.store.shown().view) };
  }

  private paint(brush: Brush, view: View): void {
    const { loss, marks, view: name } = this.store.shown();
    const drawn = this.drawn();
    if (loss && name === "force") this.paintLoss(brush, view, drawn);
    const preview = this.preview();
    preview?.lines.forEach((line, i) =>
      this.paintLine(brush, view, line, { colour: palette().text, width_px: i ? 1 : 1.5, dash: [1.5, 3] }),
    );
    for (const one of [...drawn].reverse()) {
      const stroke = strokeFor(one);
      const opacity = (stroke.opacity ?? 1) * this.opacity(one.button.id);
      this.paintLine(brush, view, one.line, { ...stroke, opacity });
    }
    if (marks && name === "force")
      for (const one of drawn)
        if (one.n < DISTINCT && this.opacity(one.button.id) === 1) this.paintMarks(brush, view, one);
    const stamp = this.stamp();
    if (stamp !== null) this.paintNames(brush, view, drawn, stamp);
  }

  private paintLine(brush: Brush, view: View, line: Line, stroke: Stroke): void {
    brush.line(line.x_mm.map(view.x.px), line.y.map(view.y.px), stroke);
  }

  /** Fill what lies between press and release: the work that is not given back. */
  private paintLoss(brush: Brush, view: View, drawn: readonly Drawn[]): void {
    for (const press of drawn.filter((one) => one.stroke === "press" && one.n < DISTINCT)) {
      const back = drawn.find((one) => one.n === press.n && one.stroke === "release");
      if (!back) continue;
      const x = [...press.line.x_mm, ...[...back.line.x_mm].reverse()].map(view.x.px);
      const y = [...press.line.y, ...[...back.line.y].reverse()].map(view.y.px);
      brush.area(x, y, { colour: strokeOf(press.n).colour, opacity: 0.12 });
    }
  }

  /** Peak: filled circle; valley: open circle; actuation: filled square; reset: open square. */
  private paintMarks(brush: Brush, view: View, one: Drawn): void {
    const { numbers } = one.button;
    const { colour } = strokeOf(one.n);
    const surface = { colour: palette().surface };
    const place = (x_mm: number | null | undefined) => {
      const y = x_mm === null || x_mm === undefined ? NaN : valueAt(one.line, x_mm);
      return Number.isFinite(y) ? { x_px: view.x.px(x_mm as number), y_px: view.y.px(y) } : null;
    };
    const round = (at: { x_px: number; y_px: number } | null, filled: boolean) =>
      at && brush.circle(at, 4, filled ? { colour } : surface, { colour, width_px: 1.5 });
    const square = (at: { x_px: number; y_px: number } | null, filled: boolean) =>
      at &&
      brush.rect(
        { left: at.x_px - 3.5, top: at.y_px - 3.5, width: 7, height: 7 },
        filled ? { colour } : surface,
        { colour, width_px: 1.5 },
      );
    if (one.stroke === "release") return void square(place(numbers.reset_mm), false);
    round(place(numbers.peak_mm), true);
    round(place(numbers.valley_mm), false);
    square(place(numbers.actuation_mm), true);
  }

  private paintNames(brush: Brush, view: View, drawn: readonly Drawn[], stamp: string): void {
    const { text, muted, surface } = palette();
    const left = view.box.left + 10;
    let top = view.box.top + 12;
    const named = drawn.filter(
      (one, i) => one.n < DISTINCT && drawn.findIndex((other) => other.n === one.n) === i,
    );
    for (const one of named) {
      brush.line([left, left + 30], [top, top], strokeOf(one.n));
      const words = `${one.button.name}${one.button.simulated ? ", simulated" : ""} (${speedText(one.velocity_mm_s)})`;
      brush.text(words, { x_px: left + 36, y_px: top }, { colour: text, size_px: 11, halo: surface });
      top += 15;
    }
    const corner = { x_px: view.box.left + view.box.width - 6, y_px: view.box.top + view.box.height - 6 };
    brush.text(stamp, corner, { colour: muted, size_px: 10, align: "right", base: "bottom", halo: surface });
  }

  private paintCursor(brush: Brush, view: View): void {
    const at = this.cursor_mm();
    if (at === null || at < view.x.range.low || at > view.x.range.high) return;
    const x = view.x.px(at);
    brush.line([x, x], [view.box.top, view.box.top + view.box.height], {
      colour: palette().muted,
      dash: [3, 3],
    });
    for (const one of this.drawn()) {
      const value = valueAt(one.line, at);
      if (Number.isFinite(value))
        brush.circle({ x_px: x, y_px: view.y.px(value) }, 3, { colour: strokeOf(one.n).colour });
    }
  }
}

/** The press as the button's stroke; the release the same, thinner and dashed. */
function strokeFor(one: Drawn): Stroke {
  const stroke = strokeOf(one.n);
  if (one.stroke === "press") return stroke;
  return { ...stroke, width_px: 1.4, dash: RELEASE_DASH };
}
