/** Numbers as controls write and bound them. */

/** Say how a value is out of bounds; empty if it is within them. */
export function outside(
  value: number,
  o: { unit: string; least?: number | undefined; most?: number | undefined },
): string {
  if (o.least !== undefined && value < o.least) return `at least ${o.least} ${o.unit}`;
  if (o.most !== undefined && value > o.most) return `at most ${o.most} ${o.unit}`;
  return "";
}

/** Write a number with at most so many decimals, without trailing zeros, with a true minus sign. */
export function shown(value: number, digits = 2): string {
  const text = Number(value.toFixed(digits)).toString();
  return text.replace("-", "−");
}
