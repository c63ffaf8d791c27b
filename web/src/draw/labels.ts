/** Names at the ends of curves: each beside its curve, none over another. */

import type { Brush } from "./brush";
import { palette } from "./palette";
import type { EndLabel, View } from "./types";

const LINE_px = 14;
const SIZE_px = 11;
/** About the mean width of a letter of this size. */
const LETTER_px = 6.1;
const GAP_px = 6;

/**
 * Return a place for each label, as near to what is wanted as can be without overlap, all within a range; null for
 * those that find no room, the lightest first. wanted_px : middles. high_px : height of every label.
 */
export function placeLabels(
  wanted_px: readonly number[],
  high_px: number,
  range: { readonly low: number; readonly high: number },
  weights: readonly number[] = [],
): (number | null)[] {
  const room = Math.max(0, Math.floor((range.high - range.low) / high_px));
  const kept = wanted_px
    .map((_, i) => i)
    .sort((a, b) => (weights[b] ?? 0) - (weights[a] ?? 0))
    .slice(0, room)
    .sort((a, b) => wanted_px[a]! - wanted_px[b]!);
  const found: (number | null)[] = wanted_px.map(() => null);
  for (const block of blocks(kept, wanted_px, high_px, range))
    block.members.forEach((i, n) => {
      found[i] = block.first + n * high_px;
    });
  return found;
}

interface Block {
  readonly members: readonly number[];
  /** Middle of the first label. */
  readonly first: number;
}

/** Pool neighbours that would overlap, each pool where its members want it in the mean. */
function blocks(
  order: readonly number[],
  wanted_px: readonly number[],
  high_px: number,
  range: { readonly low: number; readonly high: number },
): Block[] {
  const place = (members: readonly number[]): Block => {
    const mean = members.reduce((sum, i, n) => sum + wanted_px[i]! - n * high_px, 0) / members.length;
    const most = range.high - (members.length - 0.5) * high_px;
    return { members, first: Math.max(range.low + high_px / 2, Math.min(most, mean)) };
  };
  const pools: Block[] = [];
  for (const i of order) {
    let next = place([i]);
    for (let last = pools.at(-1); last; last = pools.at(-1)) {
      if (last.first + (last.members.length - 0.5) * high_px <= next.first - high_px / 2 + 1e-9) break;
      pools.pop();
      next = place([...last.members, ...next.members]);
    }
    pools.push(next);
  }
  return pools;
}

/** Return the room that names need beside a plot, px, at most a share of its width. */
export function labelRoom_px(texts: readonly string[], width_px: number): number {
  const widest = Math.max(0, ...texts.map((text) => text.length));
  return widest ? Math.min(widest * LETTER_px + 2 * GAP_px + 8, 0.26 * width_px) : 0;
}

/** Paint names in the margin on the right, each joined to the end of its curve. */
export function paintEndLabels(brush: Brush, view: View, labels: readonly EndLabel[]): void {
  const { box } = view;
  const left_px = box.left + box.width + GAP_px + 6;
  const range = { low: box.top - LINE_px / 2, high: box.top + box.height + LINE_px / 2 };
  const within = (y_px: number) => Math.min(box.top + box.height, Math.max(box.top, y_px));
  const ends = labels.map((one) => ({ x_px: view.x.px(one.x), y_px: within(view.y.px(one.y)) }));
  const y = placeLabels(
    ends.map(({ y_px }) => y_px),
    LINE_px,
    range,
    labels.map((one) => one.weight ?? 0),
  );
  const letters = Math.floor((view.width_px - left_px - 2) / LETTER_px);
  labels.forEach((one, i) => {
    const at = y[i];
    if (at === null || at === undefined) return;
    const { x_px, y_px } = ends[i]!;
    const line = { colour: one.colour, width_px: 1, opacity: 0.5 * (one.opacity ?? 1) };
    brush.line([Math.min(x_px + 3, left_px - 8), left_px - 8, left_px - 2], [y_px, at, at], line);
    const text = one.text.length > letters ? `${one.text.slice(0, Math.max(1, letters - 1))}…` : one.text;
    brush.text(
      text,
      { x_px: left_px, y_px: at },
      {
        colour: (one.opacity ?? 1) < 1 ? palette().muted : one.colour,
        size_px: SIZE_px,
        weight: one.weight ? 600 : 400,
      },
    );
  });
}
