/** Places in a document, such as `states[1].transitions[0]`, as findings tell them. */

import type { ProgramDocument } from "./document";
import { transitionsOf } from "./document";

/** What can be chosen to look at. */
export type Choice =
  | { readonly kind: "program" }
  | { readonly kind: "state"; readonly state: string }
  | { readonly kind: "transition"; readonly state: string; readonly index: number }
  | { readonly kind: "surface"; readonly surface: string }
  | { readonly kind: "signal"; readonly signal: string }
  | { readonly kind: "vibration"; readonly index: number };

/** Nothing but the program itself is chosen. */
export const WHOLE: Choice = { kind: "program" };

/** Return what a path leads to; the nearest part that is there, else the program. */
export function choiceAt(document: ProgramDocument, path: string): Choice {
  const [, part, number] = /^(states|surfaces|signals|vibrations)\[(\d+)\]/.exec(path) ?? [];
  const index = Number(number);
  if (part === "states") return stateAt(document, index, path);
  const surface = part === "surfaces" ? document.surfaces[index] : undefined;
  if (surface) return { kind: "surface", surface: surface.name };
  const signal = part === "signals" ? document.signals?.[index] : undefined;
  if (signal) return { kind: "signal", signal: signal.name };
  return part === "vibrations" && document.vibrations?.[index] ? { kind: "vibration", index } : WHOLE;
}

function stateAt(document: ProgramDocument, index: number, path: string): Choice {
  const state = document.states[index];
  if (!state) return WHOLE;
  const transition = /\.transitions\[(\d+)\]/.exec(path);
  if (transition && Number(transition[1]) < transitionsOf(state).length)
    return { kind: "transition", state: state.name, index: Number(transition[1]) };
  return { kind: "state", state: state.name };
}

/** Return the path of what is chosen; empty for the program. */
export function pathOf(document: ProgramDocument, choice: Choice): string {
  switch (choice.kind) {
    case "program":
      return "";
    case "state":
      return `states[${document.states.findIndex((state) => state.name === choice.state)}]`;
    case "transition":
      return `states[${document.states.findIndex((state) => state.name === choice.state)}].transitions[${choice.index}]`;
    case "surface":
      return `surfaces[${document.surfaces.findIndex((surface) => surface.name === choice.surface)}]`;
    case "signal":
      return `signals[${(document.signals ?? []).findIndex((signal) => signal.name === choice.signal)}]`;
    case "vibration":
      return `vibrations[${choice.index}]`;
  }
}

/** Whether what is chosen is still there; after an undo it may not be. */
export function isThere(document: ProgramDocument, choice: Choice): boolean {
  if (choice.kind === "program") return true;
  const found = choiceAt(document, pathOf(document, choice));
  return found.kind === choice.kind;
}
