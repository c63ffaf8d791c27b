import button from "../../../packages/fdvv/src/fdvv/program/library/button.fdvv-program.json";
import dwellTicks from "../../../packages/fdvv/src/fdvv/program/library/dwell-ticks.fdvv-program.json";
import fastTapping from "../../../packages/fdvv/src/fdvv/program/library/fast-tapping.fdvv-program.json";
import multiLevel from "../../../packages/fdvv/src/fdvv/program/library/multi-level.fdvv-program.json";
import nonNewtonian from "../../../packages/fdvv/src/fdvv/program/library/non-newtonian.fdvv-program.json";
import rapidTrigger from "../../../packages/fdvv/src/fdvv/program/library/rapid-trigger.fdvv-program.json";
import returningLater from "../../../packages/fdvv/src/fdvv/program/library/returning-later.fdvv-program.json";
import { condition } from "../../src/programs/condition";
import type { ProgramDocument, Transition } from "../../src/programs/document";
import { readDocument } from "../../src/programs/document";

/** The shipped programs, as their files hold them. */
export const SHIPPED: readonly ProgramDocument[] = [
  button,
  dwellTicks,
  fastTapping,
  multiLevel,
  nonNewtonian,
  rapidTrigger,
  returningLater,
].map((found) => readDocument(JSON.stringify(found)));

/** A generator of numbers from 0 to below 1 that gives the same ones for the same seed (mulberry32). */
export function seeded(seed: number): () => number {
  let held = seed;
  return () => {
    held = (held + 0x6d2b79f5) | 0;
    let mixed = Math.imul(held ^ (held >>> 15), 1 | held);
    mixed = (mixed + Math.imul(mixed ^ (mixed >>> 7), 61 | mixed)) ^ mixed;
    return ((mixed ^ (mixed >>> 14)) >>> 0) / 2 ** 32;
  };
}

/** Draw a program of so many states and ways between any two of them, themselves included. */
export function randomProgram(seed: number, states: number, transitions: number): ProgramDocument {
  const random = seeded(seed);
  const pick = (count: number): number => Math.floor(random() * count);
  const lists: Transition[][] = Array.from({ length: states }, () => []);
  for (let i = 0; i < transitions; i += 1) {
    const when = condition("deeper_than_mm", Math.round(random() * 600) / 100);
    const guard = random() < 0.3 ? { only_if: condition("slower_than_mm_s", pick(400)) } : {};
    lists[pick(states)]!.push({ to: `state ${pick(states)}`, when, ...guard });
  }
  return {
    format: "fdvv-program",
    version: 1,
    name: `random ${seed}`,
    travel_mm: 4,
    start: `state ${pick(states)}`,
    states: lists.map((transitions, i) => ({
      name: `state ${i}`,
      press: "push",
      release: "push",
      transitions,
    })),
    surfaces: [{ name: "push", displacement_mm: [0, 1], velocity_mm_s: [0], force_cN: [[40, 40]] }],
  };
}
