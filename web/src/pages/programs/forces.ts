/** The forces of the chosen state beside the graph: its curves, its points to pull, where it leads on. */

import { Plot, type Range, rangeOf } from "../../draw";
import { type Stroke, type Surface, stateNamed, surfaceNamed } from "../../programs/document";
import { computed, signal } from "../../ui";
import type { ProgramBook } from "./book";
import { drawCurves, drawHeat, drawPoints, type ForcePicture } from "./forces_draw";
import { type Editing, PointEdits } from "./forces_edits";
import { pullByHand } from "./forces_hand";

/** How fast fingers press at most, mostly: the map goes so far. */
const FASTEST_mm_s = 300;
const HEIGHT_px = 280;

interface Seen {
  readonly x: Range;
  readonly y: Range;
}

/** Both pictures of the forces of the state that is chosen in the graph, and what is edited in them. */
export class ForcePlots {
  readonly editing: Editing;
  readonly surface: () => Surface | null;
  readonly edits: PointEdits;
  readonly curves: Plot;
  /** All velocities at once. */
  readonly map: Plot;
  private readonly picture: () => ForcePicture | null;
  /** What is seen while a point is pulled: the axes must not follow the hand. */
  private readonly frozen = signal<Seen | null>(null);

  constructor(private readonly book: ProgramBook) {
    this.editing = {
      state: signal(book.document.peek().start),
      stroke: signal<Stroke>("press"),
      row: signal(0),
      column: signal(0),
      reach_mm: signal(0),
    };
    this.surface = computed(() => {
      const held = stateNamed(book.document(), this.editing.state());
      return (held && surfaceNamed(book.document(), held[this.editing.stroke()])) ?? null;
    });
    this.edits = new PointEdits(book, this.editing, this.surface);
    this.picture = computed(() => this.pictured());
    this.curves = this.curvesPlot();
    this.map = this.mapPlot();
    pullByHand(this.curves, this.edits, (pulling) => this.frozen.set(pulling ? this.whole() : null));
  }

  /** Edit the forces of another stroke. */
  turn(stroke: Stroke): void {
    this.editing.stroke.set(stroke);
    this.editing.row.set(0);
    this.editing.column.set(0);
  }

  private curvesPlot(): Plot {
    return new Plot({
      label: "Force over displacement in the chosen state, for the press and the release at each velocity",
      x: { label: "displacement", unit: "mm" },
      y: { label: "force against the finger", unit: "cN" },
      whole: () => this.frozen() ?? this.whole(),
      still: (brush, view) => {
        const picture = this.picture();
        if (picture) drawCurves(brush, view, picture);
      },
      moving: (brush, view) => {
        const picture = this.picture();
        if (picture) drawPoints(brush, view, picture, this.editing.column());
      },
      zoom: true,
      height_px: HEIGHT_px,
    });
  }

  private mapPlot(): Plot {
    return new Plot({
      label: "Force of the edited stroke by colour, over displacement and velocity",
      x: { label: "displacement", unit: "mm" },
      y: { label: "velocity", unit: "mm/s" },
      whole: () => {
        const speeds = this.surface()?.velocity_mm_s ?? [0];
        return {
          x: { low: 0, high: this.book.document().travel_mm },
          y: { low: 0, high: Math.max(FASTEST_mm_s, ...speeds) },
        };
      },
      still: (brush, view) => {
        const picture = this.picture();
        if (picture) drawHeat(brush, view, picture);
      },
      height_px: HEIGHT_px,
    });
  }

  private pictured(): ForcePicture | null {
    const document = this.book.document();
    const state = stateNamed(document, this.editing.state());
    if (!state) return null;
    return {
      document,
      state,
      stroke: this.editing.stroke(),
      row: this.edits.row,
      press: surfaceNamed(document, state.press) ?? null,
      release: surfaceNamed(document, state.release) ?? null,
      findings: this.book.findings(),
    };
  }

  private whole(): Seen {
    const picture = this.picture();
    const travel_mm = picture?.document.travel_mm ?? 4;
    const rows = [picture?.press, picture?.release].flatMap((surface) => surface?.force_cN ?? []);
    const forces = rangeOf([...rows, [0, 10]], 0.08) ?? { low: 0, high: 100 };
    return { x: { low: -0.1, high: travel_mm * 1.04 }, y: forces };
  }
}
