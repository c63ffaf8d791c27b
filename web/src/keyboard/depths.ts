/** How deep a key was over time, and how fast it moves. */

/** One reading. t_ms: of the report, on the page's clock. */
export interface Sample {
  readonly t_ms: number;
  readonly depth_mm: number;
  /** Positive downward. */
  readonly velocity_mm_s: number;
  readonly stroke: "press" | "release";
}

/** Readings that are kept: five seconds of a keyboard that reports 8000 times a second. */
const KEPT = 40_000;
/** A line is fitted to what was read in this time; its speed is that of half of it ago. */
const FITTED_ms = 12;
/** A keyboard may report a key only while it moves: after such a silence it lies still. */
const SILENT_ms = 40;
/** The stroke turns where the key went back so far: more than steps and noise of a sensor. */
const TURN_mm = 0.05;

export class Depths {
  readonly t_ms = new Float64Array(KEPT);
  readonly depth_mm = new Float32Array(KEPT);
  /** How many readings ever came; number i lies at i % KEPT. */
  count = 0;
  private stroke: Sample["stroke"] = "press";
  private turn_mm = 0;
  private last: Sample | null = null;

  /** Add a reading, and return it with its speed. */
  add(t_ms: number, depth_mm: number): Sample {
    const at = this.count++ % KEPT;
    this.t_ms[at] = t_ms;
    this.depth_mm[at] = depth_mm;
    this.turn(depth_mm);
    this.last = { t_ms, depth_mm, velocity_mm_s: this.slope_mm_s(t_ms), stroke: this.stroke };
    return this.last;
  }

  /** Return the key as it is now; null before the first reading. */
  now(now_ms: number): Sample | null {
    if (!this.last || now_ms - this.last.t_ms < SILENT_ms) return this.last;
    return { ...this.last, velocity_mm_s: 0 };
  }

  /** Return where the key was last; 0 before the first reading. */
  last_mm(): number {
    return this.last?.depth_mm ?? 0;
  }

  clear(): void {
    this.count = 0;
    this.stroke = "press";
    this.turn_mm = 0;
    this.last = null;
  }

  /** Return readings since a time, oldest first, at most so many; before them the one that held at that time. */
  since(from_ms: number, most = Infinity): { t_ms: number[]; depth_mm: number[] } {
    const oldest = Math.max(0, this.count - KEPT);
    let first = this.count;
    while (first > oldest && (this.t_ms[(first - 1) % KEPT] as number) >= from_ms) first--;
    first = Math.max(oldest, first - 1);
    const every = Math.max(1, Math.ceil((this.count - first) / most));
    const found = { t_ms: [] as number[], depth_mm: [] as number[] };
    // chosen by their number, so that a picture that moves does not shimmer
    for (let row = first; row < this.count; row++) {
      if (row % every && row !== this.count - 1) continue;
      found.t_ms.push(this.t_ms[row % KEPT] as number);
      found.depth_mm.push(this.depth_mm[row % KEPT] as number);
    }
    return found;
  }

  /** Reports a second over the last half second of readings; 0 while there are too few. */
  rate_Hz(): number {
    const end_ms = this.t_ms[(this.count - 1) % KEPT] as number;
    const { t_ms } = this.since(end_ms - 500);
    const span_ms = end_ms - (t_ms[1] ?? end_ms);
    return span_ms > 0 ? ((t_ms.length - 2) / span_ms) * 1000 : 0;
  }

  private turn(depth_mm: number): void {
    const way = this.stroke === "press" ? 1 : -1;
    if (way * (depth_mm - this.turn_mm) > 0) this.turn_mm = depth_mm;
    else if (way * (this.turn_mm - depth_mm) >= TURN_mm) {
      this.stroke = way > 0 ? "release" : "press";
      this.turn_mm = depth_mm;
    }
  }

  /** Slope of the least-squares line through the last readings. */
  private slope_mm_s(now_ms: number): number {
    let [n, t, x, tt, tx] = [0, 0, 0, 0, 0];
    for (let row = this.count - 1; row >= Math.max(0, this.count - KEPT); row--) {
      const [age, depth] = [(this.t_ms[row % KEPT] as number) - now_ms, this.depth_mm[row % KEPT] as number];
      if (age < -FITTED_ms && n > 1) break;
      if (age < -SILENT_ms) break;
      [n, t, x, tt, tx] = [n + 1, t + age, x + depth, tt + age * age, tx + age * depth];
    }
    const spread = n * tt - t * t;
    return spread > 1e-6 ? (1000 * (n * tx - t * x)) / spread : 0;
  }
}
