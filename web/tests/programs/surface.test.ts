import { describe, expect, it } from "vitest";
import type { Surface } from "../../src/programs/document";
import * as made from "../../src/programs/surface";
import golden from "./golden_surfaces.json";
import { SHIPPED } from "./shipped";

const BASE = golden.base as Surface;

function near(found: Surface, wanted: Surface): void {
  expect(found.name).toBe(wanted.name);
  expect(found.displacement_mm).toEqual(wanted.displacement_mm);
  expect(found.velocity_mm_s).toEqual(wanted.velocity_mm_s);
  found.force_cN.forEach((row, i) =>
    row.forEach((force, j) => expect(force).toBeCloseTo(wanted.force_cN[i]![j]!, 3)),
  );
}

describe("surfaces", () => {
  it("are what fdvv.program makes of the same numbers", () => {
    near(
      made.raisedSurface({ ...BASE, name: "raised" }, golden.points as [number, number][]),
      golden.raised as Surface,
    );
    near(made.lineSurface("line", golden.points as [number, number][]), golden.line as Surface);
    near(made.flatSurface("flat", -20), golden.flat as Surface);
  });

  it("have at any place the force that fdvv.program tells", () => {
    for (const [x_mm, v_mm_s, force_cN] of golden.places as [number, number, number][])
      expect(made.forceAt_cN(BASE, x_mm, v_mm_s)).toBeCloseTo(force_cN, 9);
  });

  it("are simplified within the bound, at every one of their points", () => {
    for (const surface of SHIPPED.flatMap((document) => document.surfaces))
      for (const bound_cN of [0.1, 1, 5]) {
        const few = made.simplifiedSurface(surface, bound_cN);
        expect(few.displacement_mm.length).toBeLessThanOrEqual(surface.displacement_mm.length);
        surface.displacement_mm.forEach((x_mm, column) =>
          surface.velocity_mm_s.forEach((speed, row) =>
            expect(
              Math.abs(made.forceAt_cN(few, x_mm, speed) - surface.force_cN[row]![column]!),
            ).toBeLessThanOrEqual(bound_cN + 1e-9),
          ),
        );
      }
    expect(made.simplifiedSurface(SHIPPED[0]!.surfaces[0]!, 1).displacement_mm.length).toBeLessThan(30);
  });

  it("stay the same force where a column or a row is put in", () => {
    const finer = made.withRow(made.withColumn(BASE, 0.77), 120);
    for (let x_mm = -0.5; x_mm < 4; x_mm += 0.13)
      expect(made.forceAt_cN(finer, x_mm, 0)).toBeCloseTo(made.forceAt_cN(BASE, x_mm, 0), 3);
    expect(made.withColumn(finer, 0.77)).toBe(finer);
    expect(made.withRow(finer, 120)).toBe(finer);
  });

  it("keep two columns and one row", () => {
    const flat = made.flatSurface("flat", 3);
    expect(made.withoutColumn(flat, 0)).toBe(flat);
    expect(made.withoutRow(flat, 0)).toBe(flat);
    expect(made.withoutColumn(made.withColumn(flat, 0.5), 1)).toEqual(flat);
  });

  it("follow a pulled point within its reach and no farther", () => {
    const pulled = made.pulledSurface(BASE, 0, 2, 99, 0.6);
    expect(pulled.force_cN[0]![2]).toBe(99);
    BASE.displacement_mm.forEach((x_mm, i) => {
      const moved = pulled.force_cN[0]![i] !== BASE.force_cN[0]![i];
      expect(moved).toBe(Math.abs(x_mm - BASE.displacement_mm[2]!) < 0.6);
    });
    expect(pulled.force_cN.slice(1)).toEqual(BASE.force_cN.slice(1));
  });

  it("keep their columns in order however a column is moved", () => {
    for (const to_mm of [-9, 0.6, 99]) {
      const moved = made.movedColumn(BASE, 2, to_mm).displacement_mm;
      expect([...moved].sort((a, b) => a - b)).toEqual(moved);
      expect(new Set(moved).size).toBe(moved.length);
    }
  });

  it("shift and multiply as their words say", () => {
    expect(made.forceAt_cN(made.shiftedSurface(BASE, 5), 1)).toBeCloseTo(made.forceAt_cN(BASE, 1) + 5, 3);
    expect(made.forceAt_cN(made.timesSurface(BASE, 0.5), 1)).toBeCloseTo(made.forceAt_cN(BASE, 1) / 2, 3);
  });
});
