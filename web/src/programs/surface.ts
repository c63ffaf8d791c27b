import type { Surface } from "./document";

/** A point of a force line: displacement in mm, force in cN. */
export type ForcePoint = readonly [displacement_mm: number, force_cN: number];

/** Forces are kept to a ten-thousandth of a centinewton, as fdvv.program keeps them. */
function rounded_cN(force_cN: number): number {
  return Math.round(force_cN * 1e4) / 1e4 + 0;
}

/** Interpolate linearly between rising places; outside them the edge values hold. */
export function interpolate(at: number, places: readonly number[], values: readonly number[]): number {
  const last = places.length - 1;
  if (at <= places[0]!) return values[0]!;
  if (at >= places[last]!) return values[last]!;
  let low = 0;
  let high = last;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (places[middle]! <= at) low = middle;
    else high = middle;
  }
  const ratio = (at - places[low]!) / (places[high]! - places[low]!);
  return values[low]! + ratio * (values[high]! - values[low]!);
}

/** Evaluate a surface at a displacement and a velocity. */
export function forceAt_cN(surface: Surface, displacement_mm: number, velocity_mm_s = 0): number {
  const rows = surface.force_cN.map((row) => interpolate(displacement_mm, surface.displacement_mm, row));
  return interpolate(velocity_mm_s, surface.velocity_mm_s, rows);
}

/** Make a surface of straight lines between points of rising displacement, the same at every velocity. */
export function lineSurface(name: string, points: readonly ForcePoint[]): Surface {
  const sorted = [...points].sort((a, b) => a[0] - b[0]);
  return {
    name,
    displacement_mm: sorted.map(([x_mm]) => x_mm),
    velocity_mm_s: [0],
    force_cN: [sorted.map(([, force_cN]) => force_cN)],
  };
}

/** Make a surface of one force everywhere. */
export function flatSurface(name: string, force_cN: number): Surface {
  return lineSurface(name, [
    [0, force_cN],
    [1, force_cN],
  ]);
}

/** Multiply every force by a ratio. */
export function timesSurface(surface: Surface, ratio: number): Surface {
  return mapForces(surface, (force_cN) => force_cN * ratio);
}

/** Add a force everywhere. */
export function shiftedSurface(surface: Surface, by_cN: number): Surface {
  return mapForces(surface, (force_cN) => force_cN + by_cN);
}

/** Add lines between points to every row, at the surface's own points; beyond the lines nothing. */
export function raisedSurface(surface: Surface, points: readonly ForcePoint[]): Surface {
  const sorted = [...points].sort((a, b) => a[0] - b[0]);
  const places = sorted.map(([x_mm]) => x_mm);
  const forces = sorted.map(([, force_cN]) => force_cN);
  const added = surface.displacement_mm.map((x_mm) =>
    x_mm < places[0]! || x_mm > places[places.length - 1]! ? 0 : interpolate(x_mm, places, forces),
  );
  return mapForces(surface, (force_cN, column) => force_cN + added[column]!);
}

function mapForces(surface: Surface, change: (force_cN: number, column: number) => number): Surface {
  const force_cN = surface.force_cN.map((row) =>
    row.map((force, column) => rounded_cN(change(force, column))),
  );
  return { ...surface, force_cN };
}

/** Move one point's force; points nearer than `reach_mm` follow, the less the farther they are. */
export function pulledSurface(
  surface: Surface,
  row: number,
  column: number,
  force_cN: number,
  reach_mm = 0,
): Surface {
  const centre_mm = surface.displacement_mm[column]!;
  const by_cN = force_cN - surface.force_cN[row]![column]!;
  const moved = surface.force_cN[row]!.map((held_cN, i) =>
    rounded_cN(held_cN + by_cN * weight(surface.displacement_mm[i]! - centre_mm, i === column, reach_mm)),
  );
  return { ...surface, force_cN: surface.force_cN.map((held, i) => (i === row ? moved : held)) };
}

/** A raised cosine: 1 at the point itself, 0 from the reach on. */
function weight(distance_mm: number, itself: boolean, reach_mm: number): number {
  if (itself) return 1;
  return Math.abs(distance_mm) >= reach_mm ? 0 : (1 + Math.cos((Math.PI * distance_mm) / reach_mm)) / 2;
}

/** Move a column to another displacement, kept between its neighbours by at least `gap_mm`. */
export function movedColumn(surface: Surface, column: number, to_mm: number, gap_mm = 0.01): Surface {
  const places = surface.displacement_mm;
  const low = column > 0 ? places[column - 1]! + gap_mm : -2;
  const high = column < places.length - 1 ? places[column + 1]! - gap_mm : 6.4;
  if (high < low) return surface; // neighbours so near leave no room
  const held_mm = Number(Math.min(high, Math.max(low, to_mm)).toFixed(4));
  return { ...surface, displacement_mm: places.map((x_mm, i) => (i === column ? held_mm : x_mm)) };
}

/** Add a column where there is none: the forces stay as they are. */
export function withColumn(surface: Surface, at_mm: number): Surface {
  if (surface.displacement_mm.some((x_mm) => Math.abs(x_mm - at_mm) < 1e-6)) return surface;
  const before = surface.displacement_mm.filter((x_mm) => x_mm < at_mm).length;
  const add = (list: readonly number[], value: number): number[] => [
    ...list.slice(0, before),
    value,
    ...list.slice(before),
  ];
  return {
    ...surface,
    displacement_mm: add(surface.displacement_mm, at_mm),
    force_cN: surface.force_cN.map((row) =>
      add(row, rounded_cN(interpolate(at_mm, surface.displacement_mm, row))),
    ),
  };
}

/** Leave out a column; the two that a surface needs stay. */
export function withoutColumn(surface: Surface, column: number): Surface {
  if (surface.displacement_mm.length <= 2) return surface;
  const leave = (list: readonly number[]): number[] => list.filter((_, i) => i !== column);
  return {
    ...surface,
    displacement_mm: leave(surface.displacement_mm),
    force_cN: surface.force_cN.map(leave),
  };
}

/** Add a row at a velocity: the forces stay as they are. */
export function withRow(surface: Surface, velocity_mm_s: number): Surface {
  if (surface.velocity_mm_s.includes(velocity_mm_s)) return surface;
  const before = surface.velocity_mm_s.filter((v) => v < velocity_mm_s).length;
  const row = surface.displacement_mm.map((x_mm) => rounded_cN(forceAt_cN(surface, x_mm, velocity_mm_s)));
  return {
    ...surface,
    velocity_mm_s: [
      ...surface.velocity_mm_s.slice(0, before),
      velocity_mm_s,
      ...surface.velocity_mm_s.slice(before),
    ],
    force_cN: [...surface.force_cN.slice(0, before), row, ...surface.force_cN.slice(before)],
  };
}

/** Leave out a row; the one that a surface needs stays. */
export function withoutRow(surface: Surface, row: number): Surface {
  if (surface.velocity_mm_s.length <= 1) return surface;
  return {
    ...surface,
    velocity_mm_s: surface.velocity_mm_s.filter((_, i) => i !== row),
    force_cN: surface.force_cN.filter((_, i) => i !== row),
  };
}

/** Keep only the columns that are needed to stay within a bound of every row (Ramer, Douglas and Peucker). */
export function simplifiedSurface(surface: Surface, within_cN: number): Surface {
  const keep = new Set([0, surface.displacement_mm.length - 1]);
  const spans: [number, number][] = [[0, surface.displacement_mm.length - 1]];
  for (let span = spans.pop(); span; span = spans.pop()) {
    const worst = farthest(surface, span);
    if (worst.error_cN <= within_cN) continue;
    keep.add(worst.column);
    spans.push([span[0], worst.column], [worst.column, span[1]]);
  }
  const kept = <T>(list: readonly T[]): T[] => list.filter((_, i) => keep.has(i));
  return { ...surface, displacement_mm: kept(surface.displacement_mm), force_cN: surface.force_cN.map(kept) };
}

function farthest(surface: Surface, [low, high]: [number, number]): { column: number; error_cN: number } {
  const ends = [surface.displacement_mm[low]!, surface.displacement_mm[high]!];
  const worst = { column: low, error_cN: 0 };
  for (const row of surface.force_cN)
    for (let i = low + 1; i < high; i += 1) {
      const error_cN = Math.abs(
        row[i]! - interpolate(surface.displacement_mm[i]!, ends, [row[low]!, row[high]!]),
      );
      if (error_cN > worst.error_cN) Object.assign(worst, { column: i, error_cN });
    }
  return worst;
}
