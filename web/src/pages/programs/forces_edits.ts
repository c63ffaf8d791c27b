/** What is done to the points of the line of forces that is edited. */

import { type Stroke, type Surface, surfaceNamed } from "../../programs/document";
import { replaceSurface } from "../../programs/edits_parts";
import { pulledSurface, withColumn, withoutColumn } from "../../programs/surface";
import type { Signal } from "../../ui";
import type { ProgramBook } from "./book";
import { handlesOf } from "./forces_points";

const REACH_mm = 0.3;
const DENSE = 25;
/** How far behind the last point a new one is put. */
const BEYOND_mm = 0.2;

/** Which state's forces are shown, and which line of them is edited. */
export interface Editing {
  readonly state: Signal<string>;
  readonly stroke: Signal<Stroke>;
  readonly row: Signal<number>;
  /** The column of the chosen point. */
  readonly column: Signal<number>;
  readonly reach_mm: Signal<number>;
}

/** Edits of the surface that is shown; without one nothing is done. */
export class PointEdits {
  constructor(
    readonly book: ProgramBook,
    readonly editing: Editing,
    readonly surface: () => Surface | null,
  ) {}

  /** The line that is edited, among those of the surface. */
  get row(): number {
    return Math.min(this.editing.row(), (this.surface()?.velocity_mm_s.length ?? 1) - 1);
  }

  /** The point that is chosen, among those of the surface. */
  get column(): number {
    return Math.min(this.editing.column(), (this.surface()?.displacement_mm.length ?? 1) - 1);
  }

  /** How far points follow a pulled one: chosen, else a little where there are many. */
  get reach_mm(): number {
    return this.editing.reach_mm() || ((this.surface()?.displacement_mm.length ?? 0) > DENSE ? REACH_mm : 0);
  }

  change(label: string, edit: (surface: Surface) => Surface, nudge?: string): void {
    const name = this.surface()?.name;
    if (name === undefined) return;
    this.book.edit(label, (held) => replaceSurface(held, name, edit(surfaceNamed(held, name)!)), nudge);
  }

  /** Pull the chosen point to a force, its neighbours with it. */
  pull(force_cN: number): void {
    const { row, column, reach_mm } = this;
    this.change(
      "pull a point",
      (held) => pulledSurface(held, row, column, force_cN, reach_mm),
      `pull ${column}`,
    );
  }

  /** Add a point on the line, and choose it. */
  add(at_mm: number): void {
    this.change("add a point", (held) => withColumn(held, at_mm));
    const places = this.surface()?.displacement_mm ?? [];
    this.editing.column.set(
      Math.max(
        0,
        places.findIndex((x_mm) => Math.abs(x_mm - at_mm) < 1e-6),
      ),
    );
  }

  /** Add a point half-way to the next one. */
  addBehind(): void {
    const places = this.surface()?.displacement_mm ?? [0];
    const here = places[this.column]!;
    const next = places[this.column + 1] ?? here + BEYOND_mm;
    this.add(Number(((here + next) / 2).toFixed(4)));
  }

  remove(): void {
    const { column } = this;
    this.change("remove a point", (held) => withoutColumn(held, column));
  }

  /** Choose the next point that can be pulled, or the one before. */
  step(by: 1 | -1): void {
    const surface = this.surface();
    if (!surface) return;
    const [handles, held] = [handlesOf(surface), this.column];
    const at = by > 0 ? handles.findIndex((i) => i > held) : handles.findLastIndex((i) => i < held);
    if (at >= 0) this.editing.column.set(handles[at]!);
  }
}
