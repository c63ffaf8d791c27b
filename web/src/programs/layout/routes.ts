/** Which way a transition's arrow may take: curves between two nodes, loops at one. */

import { centreOf, cut, holds, onCubic } from "./geometry";
import type { Box, Cubic, Point } from "./geometry";

/** A curve that an arrow may take, and what it costs to go so far out of the way. */
export interface Route {
  readonly curve: Cubic;
  /** Tells apart routes that would lie on each other. */
  readonly lane: string;
  readonly detour: number;
}

const STEP = 52;
const FIRST = 26;
const LOOPS = 4;
const HALVINGS = 12;

/** Offer routes from one node to another, the straightest first; `count` of them on either side. */
export function routesBetween(from: Box, to: Box, count: number): readonly Route[] {
  const a = centreOf(from);
  const b = centreOf(to);
  const length = Math.hypot(b.x - a.x, b.y - a.y) || 1;
  // to the left of the way there: so a way and its way back lie apart
  const normal = { x: (b.y - a.y) / length, y: -(b.x - a.x) / length };
  const forward = a.x < b.x || (a.x === b.x && a.y < b.y);
  return Array.from({ length: 2 * count }, (_, i) => {
    const out = FIRST + STEP * Math.floor(i / 2);
    const bend = i % 2 === 0 ? out : -out;
    const curve = clipped(bent(a, b, normal, bend), from, to);
    return { curve, lane: String(forward ? bend : -bend), detour: out / 8 + (bend < 0 ? 6 : 0) };
  });
}

function bent(a: Point, b: Point, normal: Point, bend: number): Cubic {
  const at = (ratio: number): Point => ({
    x: a.x + (b.x - a.x) * ratio + normal.x * bend * 1.34,
    y: a.y + (b.y - a.y) * ratio + normal.y * bend * 1.34,
  });
  return [a, at(0.25), at(0.75), b];
}

/** Let a curve between centres begin and end at the borders of the nodes. */
function clipped(curve: Cubic, from: Box, to: Box): Cubic {
  const leaving = border(curve, from, 0, 0.5);
  const arriving = border(curve, to, 1, 0.5);
  return leaving < arriving ? cut(curve, leaving, arriving) : curve;
}

/** Find where a curve crosses the border of a box, between a parameter inside and one outside. */
function border(curve: Cubic, box: Box, inside: number, outside: number): number {
  if (holds(box, onCubic(curve, outside))) return inside;
  let [low, high] = [inside, outside];
  for (let i = 0; i < HALVINGS; i += 1) {
    const middle = (low + high) / 2;
    if (holds(box, onCubic(curve, middle))) low = middle;
    else high = middle;
  }
  return high;
}

/** Offer loops at a node: above and below it, each beyond the last. */
export function loopsAt(node: Box, count: number): readonly Route[] {
  return Array.from({ length: 2 * (count + LOOPS) }, (_, i) => {
    const size = Math.floor(i / 2);
    const up = i % 2 === 0;
    const y = up ? node.y : node.y + node.height;
    const out = (48 + 40 * size) * (up ? -1 : 1);
    const half = Math.min(18 + 12 * size, node.width / 2 - 4);
    const centre = centreOf(node);
    const curve: Cubic = [
      { x: centre.x - half, y },
      { x: centre.x - half - 14, y: y + out * 1.3 },
      { x: centre.x + half + 14, y: y + out * 1.3 },
      { x: centre.x + half, y },
    ];
    return { curve, lane: `${up ? "up" : "down"} ${size}`, detour: 6 * size + (up ? 0 : 2) };
  });
}
