import { describe, expect, it } from "vitest";
import {
  changed,
  counted,
  DEFAULTS,
  LEAST_mm,
  moved,
  NONE,
  RESTING,
  type TriggerSettings,
} from "../../src/keyboard/trigger";

/** Whether the key is down after each of some depths. */
function downs(depths_mm: readonly number[], set: TriggerSettings): boolean[] {
  let state = RESTING;
  return depths_mm.map((depth_mm) => {
    state = moved(state, depth_mm, set);
    return state.down;
  });
}

/** The same from the whole past, by what the settings mean: slow and obvious. */
function oracle(depths_mm: readonly number[], set: TriggerSettings): boolean[] {
  const found: boolean[] = [];
  for (let i = 0; i < depths_mm.length; i++) {
    const here = depths_mm[i]!;
    const past = depths_mm.slice(0, i + 1);
    const top = past.findLastIndex((depth) => depth <= set.reset_mm);
    const first = past.findIndex((depth, j) => j > top && depth >= set.actuation_mm);
    if (first < 0) found.push(false);
    else if (first === i || !set.rapid) found.push(true);
    else {
      const was = found[i - 1]!;
      const change = found.lastIndexOf(!was, i - 1) + 1;
      const since = past.slice(Math.max(first, change));
      if (was) found.push(Math.max(...since) - here < set.release_mm);
      else found.push(here - Math.min(...since) >= set.press_mm);
    }
  }
  return found;
}

function draws(seed: number): () => number {
  let state = seed;
  return () => {
    state = (state * 48271) % 2147483647;
    return state / 2147483647;
  };
}

/** A key that wanders, in steps of a sixteenth so that sums are exact. */
function wandering(random: () => number, length = 200): number[] {
  let sixteenths = 0;
  return Array.from({ length }, () => {
    const step = Math.floor(random() * 13) - 6;
    sixteenths = Math.min(64, Math.max(0, sixteenths + step));
    return sixteenths / 16;
  });
}

function settings(random: () => number, rapid: boolean): TriggerSettings {
  const pick = (least: number, most: number) => (least + Math.floor(random() * (most - least + 1))) / 16;
  const actuation_mm = pick(2, 56);
  const reset_mm = Math.min(actuation_mm - 1 / 16, pick(0, 56));
  return { actuation_mm, reset_mm, rapid, press_mm: pick(1, 24), release_mm: pick(1, 24) };
}

describe("a key with actuation and reset point", () => {
  it("goes down at the one and up at the other", () => {
    expect(downs([0, 1.4, 1.5, 1.4, 1.31, 1.3, 1.4], DEFAULTS)).toEqual([
      false,
      false,
      true,
      true,
      true,
      false,
      false,
    ]);
  });

  it("goes down once in any press that only sinks, and up once in any release that only rises", () => {
    const random = draws(3);
    for (let i = 0; i < 300; i++) {
      const set = settings(random, i % 2 === 0);
      const sinking = wandering(random, 60).sort((a, b) => a - b);
      const down = downs([0, ...sinking, 4, ...sinking.toReversed(), 0], set);
      expect(down.filter((now, j) => now && !down[j - 1]).length).toBe(1);
      expect(down.filter((now, j) => !now && down[j - 1]).length).toBe(1);
    }
  });

  it("does not change while it moves within its hysteresis", () => {
    const random = draws(5);
    for (let i = 0; i < 300; i++) {
      const set = settings(random, false);
      const inside = () => set.reset_mm + (0.02 + 0.96 * random()) * (set.actuation_mm - set.reset_mm);
      const resting = Array.from({ length: 50 }, inside);
      expect(new Set(downs(resting, set))).toEqual(new Set([false]));
      expect(new Set(downs([set.actuation_mm, ...resting], set))).toEqual(new Set([true]));
    }
  });
});

describe("rapid trigger", () => {
  const rapid = { ...DEFAULTS, rapid: true, press_mm: 0.25, release_mm: 0.25 };

  it("lets the key go on the way up, and presses it again on the way down, wherever it turns", () => {
    const depths = [0, 2, 3, 2.875, 2.75, 2.5, 2.625, 2.75, 3.5, 3.25, 1.3, 1.4];
    const down = [false, true, true, true, false, false, false, true, true, false, false, false];
    expect(downs(depths, rapid)).toEqual(down);
  });

  it("ends above the reset point: then the actuation point counts again", () => {
    expect(downs([2, 1.3, 1.45, 1.5], rapid)).toEqual([true, false, false, true]);
  });

  it("agrees with its meaning, over the whole past, for keys that wander", () => {
    const random = draws(11);
    for (let i = 0; i < 400; i++) {
      const set = settings(random, i % 4 !== 0);
      const depths = wandering(random);
      expect(downs(depths, set)).toEqual(oracle(depths, set));
    }
  });

  it("does not change twice within its sensitivities", () => {
    const random = draws(13);
    for (let i = 0; i < 400; i++) {
      const set = settings(random, true);
      const depths = wandering(random);
      const down = downs(depths, set);
      const turns = down.flatMap((now, j) => (j && now !== down[j - 1] ? [j] : []));
      for (const [k, at] of turns.entries()) {
        const before = turns[k - 1];
        if (before === undefined) continue;
        const between = depths.slice(before, at + 1);
        const way = Math.max(...between) - Math.min(...between);
        const least = down[at] ? set.press_mm : set.release_mm;
        // between them the key moved as far as is set, or passed the reset point
        const reset = between.some((depth) => depth <= set.reset_mm);
        expect(way >= least || reset).toBe(true);
      }
    }
  });
});

describe("the settings of a trigger", () => {
  it("keep the reset point above the actuation point, whatever is set", () => {
    const random = draws(17);
    let set = DEFAULTS;
    for (let i = 0; i < 500; i++) {
      set = changed(set, { [random() < 0.5 ? "actuation_mm" : "reset_mm"]: 4 * random() });
      expect(set.actuation_mm - set.reset_mm).toBeGreaterThan(LEAST_mm - 1e-6);
      expect(set.reset_mm).toBeGreaterThanOrEqual(0);
    }
  });

  it("leave what was set last, and move the other", () => {
    expect(changed(DEFAULTS, { actuation_mm: 1 })).toMatchObject({ actuation_mm: 1, reset_mm: 0.95 });
    expect(changed(DEFAULTS, { reset_mm: 2 })).toMatchObject({ actuation_mm: 2.05, reset_mm: 2 });
  });
});

describe("actuations", () => {
  it("are counted and timed", () => {
    let all = counted(NONE, true, 100);
    expect(all).toMatchObject({ count: 1, held_ms: null, apart_ms: null });
    all = counted(counted(all, false, 180), true, 350);
    expect(all).toMatchObject({ count: 2, held_ms: null, apart_ms: 250 });
    expect(counted(all, false, 400).held_ms).toBe(50);
  });
});
