/** Edits of what a model says beside its curves: name, travel and points, interpolation, provenance. */

import { g, type Interpolation } from "../math";
import { type Edit, noted } from "./edit";
import type { FDVVModel, Provenance } from "./types";

/** The numbers of a model that a designer sets. */
export type ModelNumber = "travel_mm" | "actuation_mm" | "reset_mm";

const WORDS: Record<ModelNumber, string> = {
  travel_mm: "travel",
  actuation_mm: "actuation",
  reset_mm: "reset",
};

/** Set travel, actuation or reset; null if it is unknown. A point that is set was not measured: it has no spread. */
export function setNumber(which: ModelNumber, value_mm: number | null): Edit {
  const word = WORDS[which];
  return {
    label: value_mm === null ? `forget the ${word}` : `set ${word} to ${g(value_mm)} mm`,
    change: (model) => {
      // a travel is never unknown: 0 is refused by the check that every edit passes
      const placed: FDVVModel = { ...model, [which]: which === "travel_mm" ? (value_mm ?? 0) : value_mm };
      return model[which] === value_mm ? model : without(placed, `${word}_spread` as keyof FDVVModel);
    },
  };
}

function without(model: FDVVModel, field: keyof FDVVModel): FDVVModel {
  const { [field]: _gone, ...kept } = model;
  return kept as FDVVModel;
}

/** Choose how force is found between the velocities. */
export function setInterpolation(interpolation: Interpolation): Edit {
  return { label: `interpolate by ${interpolation}`, change: (model) => ({ ...model, interpolation }) };
}

/** Return the model another name. */
export function renameModel(name: string): Edit {
  return { label: `rename to ${name.trim()}`, change: (model) => ({ ...model, name: name.trim() }) };
}

/** Say something about where the model comes from. */
export function setProvenance(facts: Partial<Provenance>): Edit {
  return {
    label: `tell the ${Object.keys(facts).join(", ")}`,
    change: (model) => ({ ...model, provenance: { ...model.provenance, ...facts } }),
  };
}

/** Add a sentence to the method of the provenance. */
export function addNote(note: string): Edit {
  return { label: "add a note", change: (model) => noted(model, note.trim()) };
}
