/** Spans of displacement, for bars in a plot. */

/** Where a ratio is above a half: spans of displacement, each at least a place wide. */
export function spans(at_mm: readonly number[], ratio: readonly number[]): [number, number][] {
  const half = at_mm.length > 1 ? ((at_mm[1] as number) - (at_mm[0] as number)) / 2 : 0;
  const found: [number, number][] = [];
  at_mm.forEach((mm, i) => {
    if ((ratio[i] as number) <= 0.5) return;
    const last = found.at(-1);
    if (last && i > 0 && (ratio[i - 1] as number) > 0.5) last[1] = mm + half;
    else found.push([mm - half, mm + half]);
  });
  return found;
}
