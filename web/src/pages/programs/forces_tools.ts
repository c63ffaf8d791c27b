/** What can be done to a surface as a whole: another button's forces, flat, scaled, raised, simpler, its own. */

import { call } from "../../net";
import { type Stroke, type Surface, surfaceNamed } from "../../programs/document";
import { assignSurface } from "../../programs/edits";
import { copySurface, ownSurface, replaceSurface, usesOfSurface } from "../../programs/edits_parts";
import * as forces from "../../programs/surface";
import { button, choice, computed, h, numberField, signal, tell } from "../../ui";
import type { ProgramBook } from "./book";
import type { Editing } from "./forces_edits";
import { bases } from "./server";

/** A row of tools below the curves, folded until it is wanted. */
export function surfaceTools(
  book: ProgramBook,
  editing: Editing,
  surface: () => Surface | null,
): HTMLElement {
  const put = (label: string, change: (held: Surface) => Surface): void => {
    const name = surface()?.name;
    if (name !== undefined)
      book.edit(label, (held) => replaceSurface(held, name, change(surfaceNamed(held, name)!)));
  };
  return h(
    "details",
    { class: "surface-tools" },
    h("summary", {}, "Shape, copy, take from a button"),
    h(
      "div",
      { class: "stack" },
      sharing(book, editing, surface),
      shaping(put, book, editing),
      rows(put, editing, surface),
      fromButton(put, editing),
    ),
  );
}

type Put = (label: string, change: (held: Surface) => Surface) => void;

function sharing(book: ProgramBook, editing: Editing, surface: () => Surface | null): HTMLElement {
  const other = (): Stroke => (editing.stroke() === "press" ? "release" : "press");
  const here = (): { state: string; stroke: Stroke } => ({
    state: editing.state(),
    stroke: editing.stroke(),
  });
  const names = computed(() =>
    book
      .document()
      .surfaces.map((surface) => surface.name)
      .join("\n"),
  );
  return h(
    "div",
    { class: "row" },
    h("span", {}, () =>
      choice({
        label: "Uses the surface",
        options: names()
          .split("\n")
          .map((name) => [name, name] as const),
        value: () => surface()?.name ?? "",
        set: (name) =>
          book.edit(`feel ${name}`, (held) => assignSurface(held, editing.state(), editing.stroke(), name)),
      }),
    ),
    button({
      label: "Make a copy",
      hint: "A copy that only this state's stroke uses",
      disabled: () => usesOfSurface(book.document(), surface()?.name ?? "").length < 2,
      act: () =>
        book.edit(
          "copy a surface for one stroke",
          (held) => ownSurface(held, editing.state(), editing.stroke())[0],
        ),
    }),
    button({
      label: "Copy to the other stroke",
      act: () =>
        book.edit("copy to the other stroke", (held) =>
          copySurface(held, here(), { state: editing.state(), stroke: other() }),
        ),
    }),
  );
}

function shaping(put: Put, book: ProgramBook, editing: Editing): HTMLElement {
  const [ratio, level_cN, bump_cN] = [signal(1.1), signal(20), signal(10)];
  const around = (): readonly forces.ForcePoint[] => {
    const held = book.document().states.find((state) => state.name === editing.state());
    const surface = held && surfaceNamed(book.document(), held[editing.stroke()]);
    const centre_mm =
      surface?.displacement_mm[Math.min(editing.column(), surface.displacement_mm.length - 1)] ?? 1;
    return [
      [centre_mm - 0.2, 0],
      [centre_mm, bump_cN()],
      [centre_mm + 0.2, 0],
    ];
  };
  return h(
    "div",
    { class: "row" },
    numberField({
      label: "Factor",
      unit: "×",
      value: ratio,
      set: ratio.set,
      step: 0.1,
      least: -5,
      most: 5,
      bare: true,
    }),
    button({ label: "Scale", act: () => put("scale", (held) => forces.timesSurface(held, ratio())) }),
    numberField({
      label: "Force",
      unit: "cN",
      value: level_cN,
      set: level_cN.set,
      least: -400,
      most: 400,
      bare: true,
    }),
    button({
      label: "Flat",
      hint: "This force everywhere",
      act: () => put("flat", (held) => forces.flatSurface(held.name, level_cN())),
    }),
    button({
      label: "Add",
      hint: "This force on top everywhere",
      act: () => put("add a force", (held) => forces.shiftedSurface(held, level_cN())),
    }),
    numberField({
      label: "Bump",
      unit: "cN",
      value: bump_cN,
      set: bump_cN.set,
      least: -200,
      most: 200,
      bare: true,
    }),
    button({
      label: "Raise",
      hint: "A bump of 0.4 mm around the chosen point",
      act: () => put("raise", (held) => bumped(held, around())),
    }),
    button({
      label: "Fewer points",
      hint: "Within 0.5 cN of the curve",
      act: () => put("fewer points", (held) => forces.simplifiedSurface(held, 0.5)),
    }),
    button({ label: "Straight line", hint: "Between the ends", act: () => put("straight line", straight) }),
  );
}

/** Raise a surface by a bump; its corners get points of their own where the surface is coarse. */
function bumped(surface: Surface, points: readonly forces.ForcePoint[]): Surface {
  const finer = points.reduce((held, [x_mm]) => forces.withColumn(held, Number(x_mm.toFixed(4))), surface);
  return forces.raisedSurface(finer, points);
}

function straight(surface: Surface): Surface {
  const last = surface.displacement_mm.length - 1;
  const ends = (list: readonly number[]): number[] => [list[0]!, list[last]!];
  return { ...surface, displacement_mm: ends(surface.displacement_mm), force_cN: surface.force_cN.map(ends) };
}

function rows(put: Put, editing: Editing, surface: () => Surface | null): HTMLElement {
  const speed = signal(100);
  return h(
    "div",
    { class: "row" },
    numberField({
      label: "Velocity",
      unit: "mm/s",
      value: speed,
      set: speed.set,
      least: 0,
      most: 4000,
      step: 10,
    }),
    button({
      label: "Add a row",
      hint: "Separate forces at this velocity",
      act: () => put("add a velocity", (held) => forces.withRow(held, speed())),
    }),
    button({
      label: "Remove the edited row",
      disabled: () => (surface()?.velocity_mm_s.length ?? 1) < 2,
      act: () => {
        const row = editing.row.peek();
        editing.row.set(0);
        put("remove a velocity", (held) => forces.withoutRow(held, row));
      },
    }),
  );
}

function fromButton(put: Put, editing: Editing): HTMLElement {
  const base = signal("builtin:mx-clear");
  const take = async (): Promise<void> => {
    const found = await call("program.surface", { button: base.peek(), stroke: editing.stroke.peek() });
    put(`the forces of ${base.peek()}`, (held) => ({ ...held, ...found }));
  };
  return h(
    "div",
    { class: "row" },
    h("span", {}, () => choice({ label: "Button", options: bases(), value: base, set: base.set })),
    button({ label: "Take its forces", act: () => void take().catch(tell) }),
  );
}
