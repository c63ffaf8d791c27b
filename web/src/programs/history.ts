/** The history of a program: the states themselves are kept, for they share their parts. */

import { type Keeping, StepLine } from "../model/steps";
import type { ProgramDocument } from "./document";

interface Change<T> {
  readonly before: T;
  readonly after: T;
}

/** Keep whole states; two that are one object are the same. */
export function whole<T>(): Keeping<T, Change<T>> {
  return {
    between: (before, after) => (before === after ? null : { before, after }),
    forward: (_, { after }) => after,
    backward: (_, { before }) => before,
  };
}

export type ProgramHistory = StepLine<ProgramDocument, Change<ProgramDocument>>;

export function historyOf(opening: ProgramDocument): ProgramHistory {
  return new StepLine(opening, whole());
}
