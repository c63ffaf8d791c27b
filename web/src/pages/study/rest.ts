/** Breaks. */

/** Write what is left of a break as minutes and seconds. */
export function clock(left_s: number): string {
  const whole = Math.max(0, Math.ceil(left_s));
  return `${Math.floor(whole / 60)}:${String(whole % 60).padStart(2, "0")}`;
}
