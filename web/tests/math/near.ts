import { expect } from "vitest";

/** Expect numbers within a share of their size; below one unit within that share of a unit. */
export function expectNear(got: ArrayLike<number>, wanted: ArrayLike<number>, share = 1e-9): void {
  expect(got.length).toBe(wanted.length);
  for (let i = 0; i < wanted.length; i++) {
    const bound = share * Math.max(1, Math.abs(wanted[i]!));
    if (!(Math.abs(got[i]! - wanted[i]!) <= bound)) expect(got[i], `number ${i}`).toBe(wanted[i]);
  }
}

/** Draw numbers from 0 to 1 that are the same in every run. */
export function drawn(seed: number): () => number {
  let state = seed >>> 0;
  return () => {
    state = (state + 0x6d2b79f5) >>> 0;
    let mixed = Math.imul(state ^ (state >>> 15), state | 1);
    mixed ^= mixed + Math.imul(mixed ^ (mixed >>> 7), mixed | 61);
    return ((mixed ^ (mixed >>> 14)) >>> 0) / 4294967296;
  };
}
