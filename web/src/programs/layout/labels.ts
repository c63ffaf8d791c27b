/** Where the words of an arrow stand: on it if there is room, else as near as there is room. */

import { boxAround, onCubic, overlap } from "./geometry";
import type { Box, Cubic, Point } from "./geometry";

/** Width of a character and height of a line, in the font of the graph, on the safe side. */
export const TEXT = { character: 7.3, line: 17, padding: 12 } as const;
export const GAP = 4;
const ALONG = [0.5, 0.42, 0.58, 0.34, 0.66, 0.26, 0.74] as const;
const RING = 22;

/** Give the size that lines of text take. */
export function sizeOfText(lines: readonly string[]): { readonly width: number; readonly height: number } {
  const longest = Math.max(0, ...lines.map((line) => [...line].length));
  return { width: Math.ceil(longest * TEXT.character + TEXT.padding), height: TEXT.line * Math.max(1, lines.length) + 4 };
}

/** Tell whether a box keeps clear of others. */
export function isFree(box: Box, taken: readonly Box[], gap = GAP): boolean {
  return !taken.some((held) => overlap(box, held, gap));
}

/** Find a free box on a curve; null if there is none. */
export function labelOn(curve: Cubic, width: number, height: number, taken: readonly Box[]): Box | null {
  for (const t of ALONG) {
    const box = boxAround(onCubic(curve, t), width, height);
    if (isFree(box, taken)) return box;
  }
  return null;
}

/** Find the first free box on rings around a place; boxes are finitely many, so there is one. */
export function labelNear(at: Point, width: number, height: number, taken: readonly Box[]): Box {
  for (let ring = 1; ; ring += 1) {
    const steps = 8 * ring;
    for (let i = 0; i < steps; i += 1) {
      const angle = (2 * Math.PI * i) / steps;
      const centre = { x: at.x + ring * RING * Math.sin(angle), y: at.y - ring * RING * Math.cos(angle) };
      const box = boxAround(centre, width, height);
      if (isFree(box, taken)) return box;
    }
  }
}
