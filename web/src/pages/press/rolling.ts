/** The last rows of a live press, as columns in one place that never grows. */

/** Rows that are kept: at a row a millisecond, half a minute. */
const KEPT = 30_000;

export class Rolling {
  readonly t_s = new Float64Array(KEPT);
  readonly displacement_mm = new Float32Array(KEPT);
  readonly force_cN = new Float32Array(KEPT);
  /** How many rows ever came; row number i lies at i % KEPT. */
  count = 0;

  add(t_s: readonly number[], displacement_mm: readonly number[], force_cN: readonly number[]): void {
    for (let i = 0; i < t_s.length; i++) {
      const at = this.count++ % KEPT;
      this.t_s[at] = t_s[i] as number;
      this.displacement_mm[at] = displacement_mm[i] as number;
      this.force_cN[at] = force_cN[i] as number;
    }
  }

  clear(): void {
    this.count = 0;
  }

  /** Time of the last row; 0 before the first. */
  now_s(): number {
    return this.count ? (this.t_s[(this.count - 1) % KEPT] as number) : 0;
  }

  /** Return every `every`-th row since a time, the last one always, oldest first. */
  since(from_s: number, every = 1): { t_s: number[]; displacement_mm: number[]; force_cN: number[] } {
    const found = { t_s: [] as number[], displacement_mm: [] as number[], force_cN: [] as number[] };
    const oldest = Math.max(0, this.count - KEPT);
    let first = this.count;
    while (first > oldest && (this.t_s[(first - 1) % KEPT] as number) >= from_s) first--;
    // rows are chosen by their number, so that a picture that moves does not shimmer
    for (let row = first; row < this.count; row++) {
      if (row % every && row !== this.count - 1) continue;
      const at = row % KEPT;
      found.t_s.push(this.t_s[at] as number);
      found.displacement_mm.push(this.displacement_mm[at] as number);
      found.force_cN.push(this.force_cN[at] as number);
    }
    return found;
  }
}
