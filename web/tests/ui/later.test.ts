// @vitest-environment jsdom
import { afterEach, expect, it, vi } from "vitest";
import { afterPaint, effect, signal } from "../../src/ui";

afterEach(() => vi.unstubAllGlobals());

it("work that may wait runs at once the first time, then once for all changes behind the next frame", () => {
  const [frames, tasks]: [(() => void)[], (() => void)[]] = [[], []];
  vi.stubGlobal("requestAnimationFrame", (run: () => void) => frames.push(run));
  vi.stubGlobal("setTimeout", (run: () => void) => tasks.push(run));
  const [value, seen] = [signal(1), [] as number[]];
  effect(() => void seen.push(value()), afterPaint());
  value.set(2);
  value.set(3);
  expect([frames.length, tasks.length, seen]).toEqual([1, 0, [1]]);
  frames.splice(0).forEach((run) => run());
  expect(seen).toEqual([1]);
  tasks.splice(0).forEach((run) => run());
  expect(seen).toEqual([1, 3]);
  value.set(4);
  expect(frames.length).toBe(1);
});
