/** Numbers as people read them in one-line messages, as Python's `:g` writes them. */

/** Write a number with up to six significant digits. */
export function g(x: number): string {
  return Number.isFinite(x) ? String(Number(x.toPrecision(6))) : String(x);
}

/** Name a velocity. */
export function speed(velocity_mm_s: number | null): string {
  return velocity_mm_s === null ? "unknown velocity" : `${g(velocity_mm_s)} mm/s`;
}

/** Return the line that tells what went wrong, whatever was thrown. */
export function lineOf(error: unknown): string {
  return error instanceof Error ? error.message : String(error);
}
