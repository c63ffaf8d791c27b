/** What is typed into forms, read and checked. */

const MOST_mm_s = 500;
const MOST_SPEEDS = 12;

/** Read speeds with spaces or commas between them; a line of text says what is wrong. */
export function speedsOf(text: string, least_mm_s: number): readonly number[] | string {
  const parts = text.split(/[\s,;]+/).filter(Boolean);
  const speeds = parts.map(Number);
  if (!speeds.length || speeds.length > MOST_SPEEDS) return `enter 1 to ${MOST_SPEEDS} speeds`;
  if (!speeds.every((v) => Number.isFinite(v) && v >= least_mm_s && v <= MOST_mm_s)) {
    return `use numbers from ${least_mm_s} to ${MOST_mm_s} mm/s`;
  }
  if (new Set(speeds).size !== speeds.length) return "a speed is listed twice";
  return speeds;
}

/** Name what comes out of work on a button, as a file may be named. */
export function nameFor(button: string, added: string): string {
  const name = button.slice(button.indexOf(":") + 1).replace(/[^\p{L}\p{N} .+()-]+/gu, "-");
  return `${name}${added}`.slice(0, 80);
}
