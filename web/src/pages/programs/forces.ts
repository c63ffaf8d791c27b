/** The forces of the chosen state beside the graph: its curves, its points to pull, where it leads on. */

import { Plot, type Range, rangeOf } from "../../draw";
import { type Stroke, type Surface, surfaceNamed } from "../../programs/document";
import { usesOfSurface } from "../../programs/edits_parts";
import { movedColumn } from "../../programs/surface";
import {
  button,
  choice,
  computed,
  effect,
  h,
  numberField,
  panel,
  type Signal,
  shown,
  signal,
  toggle,
  toolbar,
} from "../../ui";
import type { ProgramBook } from "./book";
import { drawCurves, drawHeat, drawPoints, type ForcePicture } from "./forces_draw";
import { type Editing, PointEdits } from "./forces_edits";
import { pullByHand } from "./forces_hand";
import { surfaceTools } from "./forces_tools";

/** How fast fingers press at most, mostly: the map goes so far. */
const FASTEST_mm_s = 300;

interface Seen {
  readonly x: Range;
  readonly y: Range;
}

/** Force panel: what it shows follows the choice in the graph. */
export class ForcePanel {
  readonly element: HTMLElement;
  readonly editing: Editing;
  readonly surface: () => Surface | null;
  private readonly plot: Plot;
  private readonly heat = signal(false);
  private readonly picture: () => ForcePicture | null;
  private readonly edits: PointEdits;
  /** What is seen while a point is pulled: the axes must not follow the hand. */
  private readonly frozen = signal<Seen | null>(null);

  constructor(
    private readonly book: ProgramBook,
    state: Signal<string>,
  ) {
    this.editing = {
      state,
      stroke: signal<Stroke>("press"),
      row: signal(0),
      column: signal(0),
      reach_mm: signal(0),
    };
    this.surface = computed(() => {
      const held = book.document().states.find((state) => state.name === this.editing.state());
      return (held && surfaceNamed(book.document(), held[this.editing.stroke()])) ?? null;
    });
    this.edits = new PointEdits(book, this.editing, this.surface);
    this.picture = computed(() => this.pictured());
    this.plot = new Plot({
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
      height_px: 280,
    });
    this.plot.element.classList.add("curves");
    this.element = panel(
      "Forces of the state",
      this.controls(),
      this.picturesElement(),
      this.values(),
      surfaceTools(book, this.editing, this.surface),
    );
    this.element.classList.add("forces");
    pullByHand(this.plot, this.edits, (pulling) => this.frozen.set(pulling ? this.whole() : null));
  }

  /** See everything. */
  fit(): void {
    this.plot.fit();
  }

  /** The curves, or the map of all velocities in their place. */
  private picturesElement(): HTMLElement {
    const map = new Plot({
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
      height_px: 280,
    });
    effect(() => {
      this.plot.element.hidden = this.heat();
      map.element.hidden = !this.heat();
    });
    return h("div", {}, this.plot.element, map.element);
  }

  private pictured(): ForcePicture | null {
    const document = this.book.document();
    const state = document.states.find((state) => state.name === this.editing.state());
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

  private controls(): HTMLElement {
    const { editing, book } = this;
    const names = computed(() =>
      book
        .document()
        .states.map((state) => state.name)
        .join("\n"),
    );
    const strokes = [
      ["press", "press"],
      ["release", "release"],
    ] as const;
    // text, for a choice that is made anew would lose the keyboard at every edit
    const speeds = computed(() =>
      (this.surface()?.velocity_mm_s ?? [0]).map((speed) => `${shown(speed)} mm/s`).join("\n"),
    );
    const rows = (): readonly (readonly [string, string])[] =>
      speeds()
        .split("\n")
        .map((speed, i) => [String(i), speed] as const);
    return toolbar(
      "Which forces",
      h("span", {}, () =>
        choice({
          label: "State",
          options: names()
            .split("\n")
            .map((name) => [name, name] as const),
          value: () => editing.state(),
          set: (name) => book.choose({ kind: "state", state: name }),
        }),
      ),
      choice({ label: "Edit", options: strokes, value: editing.stroke, set: (stroke) => this.turn(stroke) }),
      h("span", {}, () =>
        rows().length < 2
          ? null
          : choice({
              label: "at",
              options: rows(),
              value: () => String(editing.row()),
              set: (row) => editing.row.set(Number(row)),
            }),
      ),
      toggle({
        label: "Map",
        value: this.heat,
        set: (on) => this.heat.set(on),
        hint: "All velocities at once, as a map",
      }),
      button({ label: "Fit", kind: "quiet", act: () => this.fit() }),
      h("span", { class: "muted uses" }, () => this.uses()),
    );
  }

  private turn(stroke: Stroke): void {
    this.editing.stroke.set(stroke);
    this.editing.row.set(0);
    this.editing.column.set(0);
  }

  private uses(): string {
    const surface = this.surface();
    if (!surface) return "";
    const count = usesOfSurface(this.book.document(), surface.name).length;
    return count > 1 ? `“${surface.name}”, used in ${count} places` : `“${surface.name}”, used here only`;
  }

  private values(): HTMLElement {
    const { edits, editing } = this;
    return h(
      "div",
      { class: "row point-values" },
      numberField({
        label: "Point at",
        unit: "mm",
        digits: 4,
        step: 0.01,
        value: () => this.surface()?.displacement_mm[edits.column] ?? null,
        set: (x_mm) =>
          edits.change("move a point", (held) => movedColumn(held, edits.column, x_mm), "column"),
      }),
      numberField({
        label: "force",
        unit: "cN",
        digits: 4,
        step: 1,
        least: -600,
        most: 600,
        value: () => this.surface()?.force_cN[edits.row]?.[edits.column] ?? null,
        set: (force_cN) => edits.pull(force_cN),
      }),
      numberField({
        label: "reach",
        unit: "mm",
        least: 0,
        most: 6,
        step: 0.1,
        value: () => edits.reach_mm,
        set: (reach) => editing.reach_mm.set(reach),
      }),
    );
  }
}
