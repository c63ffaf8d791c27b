/** Where a person has put the states of a program: remembered in this browser, for a file has no such thing. */

import type { Point } from "../../programs/layout/geometry";
import { signal, type Signal } from "../../ui";

const PREFIX = "fdvv-program-places ";

/** Give the remembered places of a program; none if what is remembered cannot be read. */
export function keptPlaces(program: string): Signal<ReadonlyMap<string, Point>> {
  return signal<ReadonlyMap<string, Point>>(readPlaces(localStorage.getItem(PREFIX + program)));
}

/** Remember places; nothing is remembered of a program whose states stand where they stood at first. */
export function keepPlaces(program: string, places: ReadonlyMap<string, Point>): void {
  if (places.size === 0) localStorage.removeItem(PREFIX + program);
  else localStorage.setItem(PREFIX + program, JSON.stringify([...places]));
}

/** Read places that were remembered, leaving out whatever is none. */
export function readPlaces(text: string | null): ReadonlyMap<string, Point> {
  try {
    const found: unknown = JSON.parse(text ?? "[]");
    return new Map(Array.isArray(found) ? found.filter(isPlace) : []);
  } catch {
    return new Map();
  }
}

function isPlace(held: unknown): held is [string, Point] {
  if (!Array.isArray(held) || typeof held[0] !== "string") return false;
  const at = held[1] as Partial<Point> | null;
  return Number.isFinite(at?.x) && Number.isFinite(at?.y);
}
