/** Selections of control points: sorted indices, changed as values. */

/** A selection with one index added if it was missing, removed if it was there. */
export function toggled(selection: readonly number[], index: number): number[] {
  return selection.includes(index) ? selection.filter((i) => i !== index) : united(selection, [index]);
}

/** Both selections together. */
export function united(a: readonly number[], b: readonly number[]): number[] {
  return [...new Set([...a, ...b])].sort((p, q) => p - q);
}

/**
 * The selection after a step along the curve. Without `extend` it is the neighbour of the end that is stepped
 * from; with it the neighbour joins. From nothing, the first or the last point is taken.
 */
export function stepped(selection: readonly number[], count: number, by: 1 | -1, extend: boolean): number[] {
  if (count === 0) return [];
  const edge = by === 1 ? Math.max(-1, ...selection) : Math.min(count, ...selection);
  const next = Math.min(count - 1, Math.max(0, edge + by));
  return extend ? united(selection, [next]) : [next];
}

/** The selection that is left when the points that were there are so many. */
export function within(selection: readonly number[], count: number): number[] {
  return selection.filter((i) => i < count);
}
