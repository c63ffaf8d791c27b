/** The offset between two clocks, from answers that wait unevenly. */

import { describe, expect, it } from "vitest";
import { ClockSync } from "../../src/net/clock";

/** Numbers in [0, 1) that are the same every time. */
function drawn(seed: number): () => number {
  let state = seed;
  return () => {
    state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
    return state / 2 ** 32;
  };
}

interface World {
  readonly offset_ms: number;
  readonly drift: number;
  /** Least way there and back, ms, and how much longer a way may be. */
  readonly there_ms: number;
  readonly back_ms: number;
  readonly wait_ms: number;
}

/** Ask every 250 ms for a while in a world whose offset is known. */
function asked(
  world: World,
  seconds: number,
  seed = 1,
): { readonly sync: ClockSync; readonly end_ms: number } {
  const [sync, random] = [new ClockSync(), drawn(seed)];
  const late = () => world.wait_ms * random() ** 3;
  let sent_ms = 1000;
  for (; sent_ms < 1000 + seconds * 1000; sent_ms += 250) {
    const there_ms = sent_ms + world.there_ms + late();
    const back_ms = there_ms + world.back_ms + late();
    sync.take({ sent_ms, back_ms, server_ms: truth(world, there_ms) + there_ms });
  }
  return { sync, end_ms: sent_ms };
}

function truth(world: World, page_ms: number): number {
  return world.offset_ms + world.drift * page_ms;
}

const EVEN: World = { offset_ms: 5e6, drift: 0, there_ms: 0.5, back_ms: 0.5, wait_ms: 8 };

describe("the offset of the server's clock", () => {
  it("is unknown before the first answer, and what came back before it was sent is none", () => {
    const sync = new ClockSync();
    sync.take({ sent_ms: 10, back_ms: 9, server_ms: 5 });
    expect(sync.at(10)).toBeNull();
    expect(sync.summary()).toBeNull();
  });

  it.each([1, 2, 3, 4, 5])("is found within its own bound although answers wait (seed %i)", (seed) => {
    for (const world of [
      EVEN,
      { ...EVEN, there_ms: 0.1, back_ms: 3 },
      { ...EVEN, drift: 5e-5 },
      { ...EVEN, drift: -1e-4 },
    ]) {
      const { sync, end_ms } = asked(world, 40, seed);
      const found = sync.at(end_ms);
      if (!found) throw new Error("nothing was found");
      expect(Math.abs(found.offset_ms - truth(world, end_ms))).toBeLessThanOrEqual(found.error_ms);
      expect(found.error_ms).toBeLessThan((world.there_ms + world.back_ms) / 2 + 1.6);
    }
  });

  it("follows a drift further than the last answer", () => {
    const world = { ...EVEN, drift: 1e-4, wait_ms: 0.2 };
    const { sync, end_ms } = asked(world, 60);
    const later_ms = end_ms + 20_000;
    const found = sync.at(later_ms);
    expect(Math.abs((found?.offset_ms ?? 0) - truth(world, later_ms))).toBeLessThan(0.5);
  });

  it("is known from one answer to half its way", () => {
    const sync = new ClockSync();
    sync.take({ sent_ms: 100, back_ms: 104, server_ms: 1102 });
    expect(sync.at(200)).toEqual({ offset_ms: 1000, error_ms: 2 });
    sync.reset();
    expect(sync.at(200)).toBeNull();
  });
});
