/** The rows of the index as columns, the sketches in one array of 16-bit numbers. */

import type { ButtonType, LibraryIndex, Origin } from "../../net/messages";

export const SKETCH_POINTS = 64;
const NO_STROKE = -32768;

export class Rows {
  epoch = 0;
  readonly ids: string[] = [];
  readonly names: string[] = [];
  readonly collections: string[] = [];
  readonly origins: Origin[] = [];
  readonly kinds: ButtonType[] = [];
  readonly stated: (readonly string[])[] = [];
  readonly speeds_mm_s: (readonly number[])[] = [];
  readonly dates: (string | null)[] = [];
  readonly simulated: boolean[] = [];
  private readonly numbers = new Map<string, (number | null)[]>();
  private readonly sketches: Int16Array[] = [];
  private readonly places = new Map<string, number>();

  get length(): number {
    return this.ids.length;
  }

  /** Return the position of a button; -1 if it is not there. */
  at(id: string): number {
    return this.places.get(id) ?? -1;
  }

  number(name: string, at: number): number | null {
    return this.numbers.get(name)?.[at] ?? null;
  }

  /** Return the force of a stroke in cN, evenly from contact to the end of the travel; null without one. */
  sketch_cN(at: number, stroke: "press" | "release"): Float32Array | null {
    const whole = this.sketches[at];
    const first = stroke === "press" ? 0 : SKETCH_POINTS;
    if (!whole || whole[first] === NO_STROKE) return null;
    return Float32Array.from(whole.subarray(first, first + SKETCH_POINTS), (tenths) => tenths / 10);
  }

  /** Take rows: at the end if they follow those that are there, else instead of them. */
  take(index: LibraryIndex): void {
    if (index.standing.epoch !== this.epoch || index.first !== this.length) this.clear();
    if (index.first !== this.length) return;
    this.epoch = index.standing.epoch;
    index.ids.forEach((id, i) => this.places.set(id, this.length + i));
    for (const name of [
      "ids",
      "names",
      "collections",
      "origins",
      "kinds",
      "stated",
      "speeds_mm_s",
      "dates",
      "simulated",
    ] as const) {
      (this[name] as unknown[]).push(...index[name]);
    }
    for (const [name, values] of Object.entries(index.numbers)) {
      const column = this.numbers.get(name) ?? [];
      column.push(...values);
      this.numbers.set(name, column);
    }
    this.sketches.push(...unpacked(index.sketches));
  }

  private clear(): void {
    for (const column of [
      this.ids,
      this.names,
      this.collections,
      this.origins,
      this.kinds,
      this.stated,
      this.speeds_mm_s,
      this.dates,
      this.simulated,
      this.sketches,
    ]) {
      column.length = 0;
    }
    this.numbers.clear();
    this.places.clear();
  }
}

/** Read sketches: a view of 128 numbers for each row. */
function unpacked(text: string): Int16Array[] {
  const binary = atob(text);
  const bytes = new Uint8Array(binary.length);
  for (let i = 0; i < binary.length; i++) bytes[i] = binary.charCodeAt(i);
  const view = new DataView(bytes.buffer);
  const all = Int16Array.from({ length: bytes.length / 2 }, (_, i) => view.getInt16(2 * i, true));
  const size = 2 * SKETCH_POINTS;
  return Array.from({ length: all.length / size }, (_, i) => all.subarray(i * size, (i + 1) * size));
}
