/** What is wrong with a document before it is sent anywhere: near the place, while a person types. */

import { shortly, valueProblem } from "./condition";
import type { ProgramDocument, State, Surface } from "./document";
import { BOUNDS, MOST, transitionsOf } from "./document";

/** One thing that makes a document no program, with the path of the part it concerns. */
export interface Problem {
  readonly path: string;
  readonly reason: string;
  readonly remedy: string;
}

/** Find what makes a document no program, or no device could hold; empty if the server may be asked. */
export function problemsOf(document: ProgramDocument): readonly Problem[] {
  return [
    ...counts(document),
    ...numbers(document),
    ...document.states.flatMap(ofState),
    ...document.surfaces.flatMap(ofSurface),
  ];
}

function counts(document: ProgramDocument): Problem[] {
  const taken = {
    states: document.states.length,
    transitions: document.states.reduce((sum, state) => sum + transitionsOf(state).length, 0),
    surfaces: document.surfaces.length,
    vibrations: document.vibrations?.length ?? 0,
    signals: document.signals?.length ?? 0,
  };
  return (Object.keys(taken) as (keyof typeof taken)[])
    .filter((what) => taken[what] > MOST[what])
    .map((what) => ({
      path: "",
      reason: `${taken[what]} ${what}, a device holds ${MOST[what]}`,
      remedy: "remove some",
    }));
}

function outside(value: number | undefined, [low, high]: readonly [number, number]): boolean {
  return value !== undefined && !(value >= low && value <= high);
}

function numbers(document: ProgramDocument): Problem[] {
  const [low, high] = BOUNDS.travel_mm;
  if (!outside(document.travel_mm, BOUNDS.travel_mm)) return [];
  return [{ path: "travel_mm", reason: `the travel is ${low} to ${high} mm`, remedy: "change it" }];
}

function ofState(state: State, index: number): Problem[] {
  const path = `states[${index}]`;
  const found = (["key", "repeat_ms", "fade_ms", "bias_ms"] as const)
    .filter((field) => outside(state[field], BOUNDS[field]) || !Number.isInteger(state[field] ?? 0))
    .map((field) => ({
      path,
      reason: `${field} is a whole number from ${BOUNDS[field][0]} to ${BOUNDS[field][1]}`,
      remedy: "change it",
    }));
  return [
    ...found,
    ...transitionsOf(state).flatMap((transition, i) =>
      ofTransition(transition.when, transition.only_if, `${path}.transitions[${i}]`),
    ),
  ];
}

function ofTransition(
  when: Parameters<typeof valueProblem>[0],
  onlyIf: Parameters<typeof valueProblem>[0] | null | undefined,
  path: string,
): Problem[] {
  return [when, ...(onlyIf ? [onlyIf] : [])].flatMap((problem) => {
    const reason = valueProblem(problem);
    return reason ? [{ path, reason: `“${shortly(problem)}”: ${reason}`, remedy: "change its value" }] : [];
  });
}

function ofSurface(surface: Surface, index: number): Problem[] {
  const rising = (list: readonly number[]): boolean =>
    list.every((value, i) => i === 0 || value > list[i - 1]!);
  const path = `surfaces[${index}]`;
  const problem = (reason: string, remedy: string): Problem[] => [{ path, reason, remedy }];
  if (!rising(surface.displacement_mm)) return problem("displacements must rise", "move its points apart");
  if (!rising(surface.velocity_mm_s))
    return problem("velocities must rise", "give each row a different velocity");
  if (!surface.force_cN.flat().every(Number.isFinite)) return problem("a force is missing", "enter a number");
  return [];
}
