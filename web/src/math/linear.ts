/** Small dense linear systems; matrices are rows of typed arrays. */

import type { Numbers } from "./types";

/** Solve a x = b by elimination with partial pivoting; a and b stay as they are. RangeError if a is singular. */
export function solve(a: readonly Numbers[], b: Numbers): Float64Array {
  const n = b.length;
  const rows = a.map((row, i) => Float64Array.from([...Array.from(row), b[i]!]));
  for (let p = 0; p < n; p++) {
    pivot(rows, p);
    for (let i = p + 1; i < n; i++) eliminate(rows[i]!, rows[p]!, p);
  }
  const x = new Float64Array(n);
  for (let i = n - 1; i >= 0; i--) {
    let rest = rows[i]![n]!;
    for (let j = i + 1; j < n; j++) rest -= rows[i]![j]! * x[j]!;
    x[i] = rest / rows[i]![i]!;
  }
  return x;
}

function pivot(rows: Float64Array[], p: number): void {
  let best = p;
  for (let i = p + 1; i < rows.length; i++) {
    if (Math.abs(rows[i]![p]!) > Math.abs(rows[best]![p]!)) best = i;
  }
  if (rows[best]![p] === 0) throw new RangeError("the equations have no single solution");
  [rows[p], rows[best]] = [rows[best]!, rows[p]!];
}

function eliminate(row: Float64Array, by: Float64Array, p: number): void {
  const share = row[p]! / by[p]!;
  if (share === 0) return;
  for (let j = p; j < row.length; j++) row[j] = row[j]! - share * by[j]!;
}
