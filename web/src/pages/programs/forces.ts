/** The forces of the chosen state beside the graph: its curves, its points to pull, where it leads on. */

import { Plot, rangeOf, type Range } from "../../draw";
import { surfaceNamed, type Stroke, type Surface } from "../../programs/document";
import { replaceSurface, usesOfSurface } from "../../programs/edits_parts";
import { movedColumn, pulledSurface, withColumn, withoutColumn } from "../../programs/surface";
import { button, choice, computed, effect, h, numberField, panel, shown, signal, toggle, toolbar, type Signal } from "../../ui";
import type { ProgramBook } from "./book";
import { drawCurves, drawHeat, drawPoints, type ForcePicture } from "./forces_draw";
import { handlesOf, nearestHandle } from "./forces_points";
import { surfaceTools } from "./forces_tools";

const REACH_mm = 0.3;
const DENSE = 25;
const NEAR_px = 22;
/** How fast fingers press at most, mostly: the map goes so far. */
const FASTEST_mm_s = 300;

/** Which state's forces are shown, and which line of them is edited. */
export interface Editing {
  readonly state: Signal<string>;
  readonly stroke: Signal<Stroke>;
  readonly row: Signal<number>;
  /** The column of the chosen point. */
  readonly column: Signal<number>;
  readonly reach_mm: Signal<number>;
}

/** Force panel: what it shows follows the choice in the graph. */
export class ForcePanel {
  readonly element: HTMLElement;
  readonly editing: Editing;
  readonly surface: () => Surface | null;
  private readonly plot: Plot;
  private readonly heat = signal(false);
  private readonly picture: () => ForcePicture | null;
  /** The range of forces while a point is pulled: the axes must not follow the hand. */
  private readonly frozen: Signal<{ readonly x: Range; readonly y: Range } | null> = signal<{
    readonly x: Range;
    readonly y: Range;
  } | null>(null);

  constructor(
    private readonly book: ProgramBook,
    state: Signal<string>,
  ) {
    this.editing = { state, stroke: signal<Stroke>("press"), row: signal(0), column: signal(0), reach_mm: signal(0) };
    this.surface = computed(() => {
      const held = book.document().states.find((one) => one.name === this.editing.state());
      return (held && surfaceNamed(book.document(), held[this.editing.stroke()])) ?? null;
    });
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
    this.element = panel("Forces of the state", this.controls(), this.picturesElement(), this.values(), surfaceTools(book, this.editing, this.surface));
    this.element.classList.add("forces");
    this.listen();
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
        return { x: { low: 0, high: this.book.document().travel_mm }, y: { low: 0, high: Math.max(FASTEST_mm_s, ...speeds) } };
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
    const state = document.states.find((one) => one.name === this.editing.state());
    if (!state) return null;
    return {
      document,
      state,
      stroke: this.editing.stroke(),
      row: Math.min(this.editing.row(), (this.surface()?.velocity_mm_s.length ?? 1) - 1),
      press: surfaceNamed(document, state.press) ?? null,
      release: surfaceNamed(document, state.release) ?? null,
      findings: this.book.findings(),
    };
  }

  private whole(): { readonly x: Range; readonly y: Range } {
    const picture = this.picture();
    const travel_mm = picture?.document.travel_mm ?? 4;
    const rows = [picture?.press, picture?.release].flatMap((surface) => surface?.force_cN ?? []);
    const forces = rangeOf([...rows, [0, 10]], 0.08) ?? { low: 0, high: 100 };
    return { x: { low: -0.1, high: travel_mm * 1.04 }, y: forces };
  }

  private controls(): HTMLElement {
    const { editing, book } = this;
    const names = computed(() => book.document().states.map((state) => state.name).join("\n"));
    const strokes = [["press", "press"], ["release", "release"]] as const;
    // text, for a choice that is made anew would lose the keyboard at every edit
    const speeds = computed(() => (this.surface()?.velocity_mm_s ?? [0]).map((speed) => `${shown(speed)} mm/s`).join("\n"));
    const rows = (): readonly (readonly [string, string])[] => speeds().split("\n").map((speed, i) => [String(i), speed] as const);
    return toolbar(
      "Which forces",
      h("span", {}, () =>
        choice({
          label: "State",
          options: names().split("\n").map((name) => [name, name] as const),
          value: () => editing.state(),
          set: (name) => book.choose({ kind: "state", state: name }),
        }),
      ),
      choice({ label: "Edit", options: strokes, value: editing.stroke, set: (stroke) => this.turn(stroke) }),
      h("span", {}, () =>
        rows().length < 2
          ? null
          : choice({ label: "at", options: rows(), value: () => String(editing.row()), set: (row) => editing.row.set(Number(row)) }),
      ),
      toggle({ label: "Map", value: this.heat, set: (on) => this.heat.set(on), hint: "All velocities at once, as a map" }),
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
    return count > 1 ? `“${surface.name}”, felt in ${count} places` : `“${surface.name}”, felt here only`;
  }

  private values(): HTMLElement {
    const { editing } = this;
    const column = (): number => Math.min(editing.column(), (this.surface()?.displacement_mm.length ?? 1) - 1);
    return h(
      "div",
      { class: "row point-values" },
      numberField({
        label: "Point at",
        unit: "mm",
        digits: 4,
        step: 0.01,
        value: () => this.surface()?.displacement_mm[column()] ?? null,
        set: (x_mm) => this.change("move a point", (held) => movedColumn(held, column(), x_mm), "column"),
      }),
      numberField({
        label: "force",
        unit: "cN",
        digits: 4,
        step: 1,
        least: -600,
        most: 600,
        value: () => this.surface()?.force_cN[this.row()]?.[column()] ?? null,
        set: (force_cN) => this.pull(column(), force_cN),
      }),
      numberField({
        label: "reach",
        unit: "mm",
        least: 0,
        most: 6,
        step: 0.1,
        value: () => this.reach_mm(),
        set: (reach) => editing.reach_mm.set(reach),
      }),
    );
  }

  private row(): number {
    return Math.min(this.editing.row(), (this.surface()?.velocity_mm_s.length ?? 1) - 1);
  }

  /** How far points follow a pulled one: chosen, else a little where there are many. */
  private reach_mm(): number {
    return this.editing.reach_mm() || ((this.surface()?.displacement_mm.length ?? 0) > DENSE ? REACH_mm : 0);
  }

  private change(label: string, edit: (surface: Surface) => Surface, nudge?: string): void {
    const name = this.surface()?.name;
    if (name === undefined) return;
    this.book.edit(label, (held) => replaceSurface(held, name, edit(surfaceNamed(held, name)!)), nudge);
  }

  private pull(column: number, force_cN: number): void {
    const [row, reach_mm] = [this.row(), this.reach_mm()];
    this.change("pull a point", (held) => pulledSurface(held, row, column, force_cN, reach_mm), `pull ${column}`);
  }

  private listen(): void {
    const { element } = this.plot;
    element.addEventListener("pointerdown", (event) => this.down(event));
    element.addEventListener("keydown", (event) => this.key(event));
    element.addEventListener("dblclick", (event) => {
      const { x } = this.plot.at(event);
      this.addPoint(Number(x.toFixed(3)));
    });
  }

  private addPoint(at_mm: number): void {
    this.change("add a point", (held) => withColumn(held, at_mm));
    const places = this.surface()?.displacement_mm ?? [];
    this.editing.column.set(Math.max(0, places.findIndex((x_mm) => Math.abs(x_mm - at_mm) < 1e-6)));
  }

  private down(event: PointerEvent): void {
    const surface = this.surface();
    if (event.button !== 0 || !surface) return;
    const column = nearestHandle(surface, this.row(), this.plot.view(), this.plot.at(event), NEAR_px);
    if (column === null) return;
    event.preventDefault();
    this.plot.element.focus();
    this.editing.column.set(column);
    this.follow(event, surface, column);
  }

  private follow(event: PointerEvent, surface: Surface, column: number): void {
    const { element } = this.plot;
    const [begin, row, reach_mm] = [this.plot.at(event), this.row(), this.reach_mm()];
    const first_cN = surface.force_cN[row]![column]!;
    this.frozen.set(this.whole());
    this.book.mark("pull a point");
    element.setPointerCapture(event.pointerId);
    const move = (now: PointerEvent): void => this.drag(surface, row, column, first_cN + this.plot.at(now).y - begin.y, reach_mm);
    const end = (kept: boolean): void => {
      element.removeEventListener("pointermove", move);
      this.frozen.set(null);
      if (kept) this.book.release();
      else this.book.cancel();
    };
    element.addEventListener("pointermove", move);
    element.addEventListener("pointerup", () => end(true), { once: true });
    element.addEventListener("pointercancel", () => end(false), { once: true });
  }

  private drag(surface: Surface, row: number, column: number, force_cN: number, reach_mm: number): void {
    const pulled = pulledSurface(surface, row, column, Number(force_cN.toFixed(1)), reach_mm);
    this.book.drag((before) => replaceSurface(before, surface.name, pulled));
  }

  private key(event: KeyboardEvent): void {
    const surface = this.surface();
    if (event.target !== this.plot.element || !surface || event.ctrlKey || event.metaKey) return;
    const held = Math.min(this.editing.column.peek(), surface.displacement_mm.length - 1);
    const by = event.key === "ArrowUp" ? 1 : event.key === "ArrowDown" ? -1 : 0;
    if (by) this.pull(held, surface.force_cN[this.row()]![held]! + by * (event.shiftKey ? 10 : event.altKey ? 0.1 : 1));
    else if (event.key === "ArrowLeft" || event.key === "ArrowRight") this.step(surface, held, event.key === "ArrowRight" ? 1 : -1);
    else if (event.key === "Delete") this.change("remove a point", (one) => withoutColumn(one, held));
    else if (event.key === "Insert") this.addPoint(this.between(surface, held));
    else return;
    event.preventDefault();
  }

  private step(surface: Surface, held: number, by: 1 | -1): void {
    const handles = handlesOf(surface);
    const at = by > 0 ? handles.findIndex((i) => i > held) : handles.findLastIndex((i) => i < held);
    if (at >= 0) this.editing.column.set(handles[at]!);
  }

  private between(surface: Surface, held: number): number {
    const places = surface.displacement_mm;
    const next = places[held + 1] ?? places[held]! + 0.2;
    return Number(((places[held]! + next) / 2).toFixed(4));
  }
}

