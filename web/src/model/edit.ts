/** Edits: a label for people and a pure change; a model comes out whole or not at all. */

import { checkModel } from "./check";
import { canonical } from "./model";
import type { FDVVModel } from "./types";

/** One thing a designer does. */
export interface Edit {
  /** For people: what undo says it takes back. */
  readonly label: string;
  /** Return the edited model. Throws ModelError. */
  readonly change: (model: FDVVModel) => FDVVModel;
}

/** Apply an edit. Throws ModelError, one line for a person, if it would break the model. */
export function applyEdit(model: FDVVModel, edit: Edit): FDVVModel {
  const made = canonical(edit.change(model));
  checkModel(made);
  return made;
}

/** Do several edits as one. */
export function together(label: string, edits: readonly Edit[]): Edit {
  return { label, change: (model) => edits.reduce((now, edit) => applyEdit(now, edit), model) };
}

/** Add a note to the method of the provenance, once. */
export function noted(model: FDVVModel, note: string): FDVVModel {
  const { method } = model.provenance;
  if (method.split("; ").includes(note)) return model;
  return { ...model, provenance: { ...model.provenance, method: method ? `${method}; ${note}` : note } };
}
