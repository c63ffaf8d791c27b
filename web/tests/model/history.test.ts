import { describe, expect, test } from "vitest";
import { diff, History, isEmpty, movePoints, removeCurve, same, setNumber } from "../../src/model";
import { builtIn } from "../golden/golden";
import { drawn } from "../math/near";
import { randomEdit } from "./random";

const clear = builtIn("mx-clear");
const points = { stroke: "press", velocity_mm_s: 0.5, indices: [4] } as const;
const force = (history: History) => history.model.curves[0]!.control_points_cN[4]!;
const start = clear.curves[0]!.control_points_cN[4]!;

test("undo and redo of random edits give identical models, to the opening and back, also from a file", () => {
  for (const name of ["mx-clear", "rubber-dome"]) {
    const random = drawn(7);
    let history = new History(builtIn(name));
    const seen = [history.model];
    for (let i = 0; i < 80; i++) {
      if (random() < 0.25 && history.canUndo) {
        const back = 1 + Math.floor(random() * 3);
        const gone = history.undo(back);
        if (random() < 0.5) history.redo(gone);
        seen.length = history.done + 1;
        expect(same(history.model, seen[history.done])).toBe(true);
        continue;
      }
      try {
        if (history.apply(randomEdit(history.model, random), { time_s: i })) {
          seen.length = history.done;
          seen.push(history.model);
        }
      } catch (error) {
        expect((error as Error).name).toBe("ModelError");
        expect(same(history.model, seen[history.done])).toBe(true);
      }
    }
    expect(seen.length).toBeGreaterThan(15);
    history = History.fromJSON(JSON.parse(JSON.stringify(history)));
    const done = history.done;
    for (let i = done; i >= 0; i--) {
      expect(same(history.model, seen[i])).toBe(true);
      expect(history.undo()).toBe(i ? 1 : 0);
    }
    expect(same(history.model, history.opening)).toBe(true);
    expect(history.redo(1000)).toBe(history.steps.length);
    expect(same(history.at(done), seen[done])).toBe(true);
  }
});

describe("a drag", () => {
  test("is one step, computed from the state at its mark", () => {
    const history = new History(clear);
    history.mark("move");
    for (const delta of [1, 5, 3]) history.drag(movePoints([points], delta));
    expect(force(history)).toBe(start + 3);
    expect(history.release(9)!.joins).toBe(false);
    expect([history.steps.length, history.undoLabel]).toEqual([1, "move a point of press at 0.5 mm/s"]);
    history.undo();
    expect(history.model).toEqual(clear);
  });

  test("that is cancelled has not been", () => {
    const history = new History(clear);
    history.mark("move");
    history.drag(movePoints([points], 5));
    history.cancel();
    expect([history.model, history.steps.length, history.dragging]).toEqual([clear, 0, false]);
  });

  test("keeps what was last shown when a place is refused", () => {
    const history = new History(clear);
    history.mark("actuation");
    history.drag(setNumber("actuation_mm", 3));
    expect(() => history.drag(setNumber("actuation_mm", 5))).toThrow("actuation_mm must lie within");
    expect(history.model.actuation_mm).toBe(3);
    history.release(1);
    expect(history.model.actuation_mm).toBe(3);
  });

  test("that comes back to where it began is no step", () => {
    const history = new History(clear);
    history.mark("actuation");
    history.drag(setNumber("actuation_mm", 3));
    history.drag(setNumber("actuation_mm", 2));
    expect([history.release(1), history.steps.length, history.canUndo]).toEqual([null, 0, false]);
  });

  test("gives way to an undo", () => {
    const history = new History(clear);
    history.apply(setNumber("actuation_mm", 3), { time_s: 0 });
    history.mark("move");
    history.drag(movePoints([points], 5));
    history.undo();
    expect([history.model, history.dragging]).toEqual([clear, false]);
  });
});

describe("nudges", () => {
  const nudge = (history: History, time_s: number, kind = "up") =>
    history.apply(movePoints([points], 0.5), { time_s, nudge: kind })!.joins;

  test("that follow each other are one step", () => {
    const history = new History(clear);
    expect([0, 0.4, 1.3].map((t) => nudge(history, t))).toEqual([false, true, true]);
    expect([history.steps.length, force(history)]).toEqual([1, start + 1.5]);
    history.undo();
    expect(history.model).toEqual(clear);
    history.redo();
    expect(force(history)).toBe(start + 1.5);
  });

  test("after a pause, of another kind, after another edit or an undo are a new step", () => {
    const history = new History(clear);
    nudge(history, 0);
    expect(nudge(history, 2)).toBe(false);
    expect(nudge(history, 2.1, "down")).toBe(false);
    history.apply(setNumber("reset_mm", 1), { time_s: 2.2 });
    expect(nudge(history, 2.3, "down")).toBe(false);
    history.undo();
    expect(nudge(history, 2.4, "down")).toBe(false);
    expect(history.steps.length).toBe(5);
  });
});

test("an edit after an undo begins a new line", () => {
  const history = new History(clear);
  history.apply(setNumber("reset_mm", 1), { time_s: 0 });
  history.undo();
  history.apply(setNumber("reset_mm", 1.5), { time_s: 1 });
  expect([history.canRedo, history.steps.length]).toEqual([false, 1]);
});

test("an edit that changes nothing is no step, one that is refused changes nothing", () => {
  const history = new History(clear);
  expect(history.apply(setNumber("reset_mm", 2), { time_s: 0 })).toBeNull();
  const wrong = removeCurve({ stroke: "press", velocity_mm_s: 7 });
  expect(() => history.apply(wrong, { time_s: 0 })).toThrow("has no press curve");
  expect([history.model, history.canUndo, history.changed]).toEqual([clear, false, false]);
});

test("a pinned state stays to compare with, whatever comes after", () => {
  const history = new History(clear);
  history.apply(setNumber("reset_mm", 1), { time_s: 0 });
  const pin = history.pin("softer");
  history.undo();
  history.apply(setNumber("reset_mm", 3), { time_s: 1 });
  expect(history.pins).toEqual([pin]);
  expect(pin.model.reset_mm).toBe(1);
  expect(isEmpty(diff(pin.model, history.model))).toBe(false);
  history.unpin(0);
  expect(history.pins).toEqual([]);
});
