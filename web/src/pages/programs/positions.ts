/** Where a person has put the states of a program: remembered in this browser, for a file has no such thing. */

import type { Point } from "../../programs/geometry";
import { type Signal, signal } from "../../ui";

const PREFIX = "fdvv-program-places ";

/** Return the remembered places of a program; none if what is remembered cannot be read. */
export function savedPositions(program: string): Signal<ReadonlyMap<string, Point>> {
  return signal<ReadonlyMap<string, Point>>(readPositions(localStorage.getItem(PREFIX + program)));
}

/** Remember places; nothing is remembered of a program whose states stand where they stood at first. */
export function savePositions(program: string, positions: ReadonlyMap<string, Point>): void {
  if (positions.size === 0) localStorage.removeItem(PREFIX + program);
  else localStorage.setItem(PREFIX + program, JSON.stringify([...positions]));
}

/** Read places that were remembered, leaving out whatever is none. */
export function readPositions(text: string | null): ReadonlyMap<string, Point> {
  try {
    const found: unknown = JSON.parse(text ?? "[]");
    return new Map(Array.isArray(found) ? found.filter(isPosition) : []);
  } catch {
    return new Map();
  }
}

function isPosition(held: unknown): held is [string, Point] {
  if (!Array.isArray(held) || typeof held[0] !== "string") return false;
  const at = held[1] as Partial<Point> | null;
  return Number.isFinite(at?.x) && Number.isFinite(at?.y);
}
