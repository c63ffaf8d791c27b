/** A range filter: how the buttons spread, a brush over it, and the two ends as numbers. */

import { palette } from "../../draw";
import type { LibraryHistogram } from "../../net/messages";
import { afterPaint, button, computed, effect, followPointer, h, numberField } from "../../ui";
import { type Column, columnOf } from "./columns";
import type { RangeAsked } from "./state";
import type { LibraryStore } from "./store";

const SIZE_px = { width: 180, height: 30 } as const;
const OPEN: RangeAsked = { low: null, high: null };

export function rangeFilter(store: LibraryStore, name: string): HTMLElement {
  const column = columnOf(name) as Column;
  // of its own, so that a letter that is typed redraws no filter
  const range = computed(() => store.query().ranges[name] ?? OPEN);
  const set = (next: RangeAsked) => {
    const others = Object.entries(store.query.peek().ranges).filter(([other]) => other !== name);
    const all = next.low === null && next.high === null ? others : [...others, [name, next] as const];
    store.ask({ ranges: Object.fromEntries(all) });
  };
  const active = () => range() !== OPEN;
  const field = (end: "low" | "high", label: string) =>
    numberField({
      label: `${column.label}, ${label}`,
      unit: column.unit || "ratio",
      value: () => range()[end],
      set: (value) => set({ ...range(), [end]: value }),
      step: 10 ** -column.digits * (column.digits === 1 ? 10 : 5),
      digits: 3,
      bare: true,
    });
  return h(
    "fieldset",
    { class: () => `lib-range${active() ? " on" : ""}` },
    h("legend", {}, h("span", { title: column.label }, column.short), column.unit ? `, ${column.unit}` : ""),
    picture(store, name, range, set),
    h(
      "div",
      { class: "lib-ends" },
      field("low", "at least"),
      h("span", { "aria-hidden": "true" }, "to"),
      field("high", "at most"),
      button({
        label: `Any ${column.short.toLowerCase()}`,
        glyph: "×",
        kind: "quiet",
        act: () => set(OPEN),
        disabled: () => !active(),
      }),
    ),
  );
}

/** The bars; dragging over them sets the range. */
function picture(
  store: LibraryStore,
  name: string,
  range: () => RangeAsked,
  set: (range: RangeAsked) => void,
): HTMLElement {
  const canvas = h("canvas", { class: "lib-bars", "aria-hidden": "true" });
  effect(() => {
    const found = store.found().histograms[name];
    draw(canvas, found, range());
  }, afterPaint());
  canvas.addEventListener("pointerdown", (event) => {
    const found = store.found.peek().histograms[name];
    if (!found) return;
    const from = valueAt(canvas, found, event);
    followPointer(canvas, event, (now) => {
      const to = valueAt(canvas, found, now);
      if (from !== to) set({ low: Math.min(from, to), high: Math.max(from, to) });
    });
  });
  return canvas;
}

/** Return the end of the bin that an event is nearest to. */
function valueAt(canvas: HTMLCanvasElement, found: LibraryHistogram, event: PointerEvent): number {
  const frame = canvas.getBoundingClientRect();
  const part = Math.min(1, Math.max(0, (event.clientX - frame.left) / frame.width));
  const bin = Math.round(part * found.counts.length) / found.counts.length;
  return Number((found.lowest + bin * (found.highest - found.lowest)).toPrecision(3));
}

function draw(canvas: HTMLCanvasElement, found: LibraryHistogram | undefined, range: RangeAsked): void {
  const ratio = window.devicePixelRatio || 1;
  canvas.width = SIZE_px.width * ratio;
  canvas.height = SIZE_px.height * ratio;
  const context = canvas.getContext("2d") as CanvasRenderingContext2D;
  context.setTransform(ratio, 0, 0, ratio, 0, 0);
  const { accent, line, muted } = { ...palette(), line: palette().grid };
  context.fillStyle = line;
  context.fillRect(0, SIZE_px.height - 1, SIZE_px.width, 1);
  if (!found) return;
  const most = Math.max(1, ...found.counts);
  const wide = SIZE_px.width / found.counts.length;
  found.counts.forEach((count, i) => {
    const middle = found.lowest + ((i + 0.5) / found.counts.length) * (found.highest - found.lowest);
    const inside =
      (range.low === null || middle >= range.low) && (range.high === null || middle <= range.high);
    // few must be seen beside many
    const tall = count ? Math.max(2, (SIZE_px.height - 2) * Math.sqrt(count / most)) : 0;
    context.fillStyle = inside ? accent : muted;
    context.globalAlpha = inside ? 0.85 : 0.3;
    context.fillRect(i * wide, SIZE_px.height - 1 - tall, wide - 1, tall);
  });
  context.globalAlpha = 1;
}
