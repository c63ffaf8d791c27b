import { describe, expect, it } from "vitest";
import { cancelled, IDLE } from "../../src/tools/curve_tool";
import { pointer, run } from "./records";

const touch = { device: "touch" } as const;

describe("a drag", () => {
  it("is one undo step that tells the total way of every move", () => {
    const { acts, state } = run([
      pointer("down", 51, 61),
      pointer("move", 60, 50),
      pointer("move", 40, 30),
      pointer("up", 41, 31),
    ]);
    const grip = { kind: "point", index: 1 };
    expect(acts).toEqual([
      { kind: "select", points: [1] },
      { kind: "begin", grip },
      { kind: "shift", grip, offset: { dx_px: 9, dy_px: -11 } },
      { kind: "shift", grip, offset: { dx_px: -11, dy_px: -31 } },
      { kind: "shift", grip, offset: { dx_px: -10, dy_px: -30 } },
      { kind: "commit" },
    ]);
    expect(state).toEqual(IDLE);
  });

  it("does not begin while the hand only trembles", () => {
    const { kinds } = run([pointer("down", 50, 60), pointer("move", 52, 61), pointer("up", 52, 61)]);
    expect(kinds).not.toContain("begin");
  });

  it("of one of many selected points keeps them all", () => {
    const { acts, selected } = run([pointer("down", 50, 60), pointer("move", 50, 90)], [1, 2]);
    expect(selected).toEqual([1, 2]);
    expect(acts[0]?.kind).toBe("begin");
  });

  it("of an unselected point takes only that one, with shift also the others", () => {
    const plain = run([pointer("down", 50, 60), pointer("move", 50, 90)], [2, 3]);
    expect(plain.selected).toEqual([1]);
    const more = run([pointer("down", 50, 60, { shift: true }), pointer("move", 50, 90)], [2, 3]);
    expect(more.selected).toEqual([1, 2, 3]);
  });

  it("goes back to its mark when it is cancelled", () => {
    const { state } = run([pointer("down", 50, 60), pointer("move", 50, 90)]);
    expect(cancelled(state)).toEqual({ state: IDLE, acts: [{ kind: "cancel" }] });
    const lost = run([pointer("down", 50, 60), pointer("move", 50, 90), pointer("cancel", 50, 90)]);
    expect(lost.kinds.at(-1)).toBe("cancel");
    expect(lost.state).toEqual(IDLE);
  });

  it("ignores other pointers and further buttons", () => {
    const { kinds } = run([
      pointer("down", 50, 60),
      pointer("move", 50, 90),
      pointer("move", 0, 0, { pointerId: 2 }),
      pointer("down", 50, 95, { button: 2 }),
      pointer("up", 50, 90),
    ]);
    expect(kinds).toEqual(["select", "begin", "shift", "shift", "commit"]);
  });

  it("of the active curve between its points pulls there", () => {
    const { acts } = run([pointer("down", 75, 243), pointer("move", 75, 260), pointer("up", 75, 260)], [1]);
    expect(acts[0]).toEqual({ kind: "begin", grip: { kind: "line" } });
    expect(acts.map((a) => a.kind)).toEqual(["begin", "shift", "shift", "commit"]);
  });

  it("of a handle works like one of a point", () => {
    const { acts } = run([pointer("down", 121, 3), pointer("move", 140, 3), pointer("up", 140, 3)]);
    const grip = { kind: "handle", name: "actuation" };
    expect(acts.map((a) => a.kind)).toEqual(["begin", "shift", "shift", "commit"]);
    expect(acts[1]).toEqual({ kind: "shift", grip, offset: { dx_px: 19, dy_px: 0 } });
  });
});

describe("a click", () => {
  it("selects one point, with shift adds it and takes it away again", () => {
    const shift = { shift: true };
    expect(run([pointer("down", 50, 60), pointer("up", 50, 60)], [2, 3]).selected).toEqual([1]);
    expect(run([pointer("down", 50, 60, shift), pointer("up", 50, 60)], [2]).selected).toEqual([1, 2]);
    expect(run([pointer("down", 50, 60, shift), pointer("up", 50, 60)], [1, 2]).selected).toEqual([2]);
  });

  it("on a selected one of many selects it alone, but only when it is let go", () => {
    const down = run([pointer("down", 50, 60)], [1, 2]);
    expect(down.selected).toEqual([1, 2]);
    expect(run([pointer("down", 50, 60), pointer("up", 50, 60)], [1, 2]).selected).toEqual([1]);
  });

  it("on nothing selects nothing, on another curve makes it the active one", () => {
    expect(run([pointer("down", 75, 140), pointer("up", 75, 140)], [1, 2]).selected).toEqual([]);
    const other = run([pointer("down", 75, 204), pointer("up", 75, 204)], [1]);
    expect(other.acts).toEqual([{ kind: "activate", curve: 7 }]);
  });

  it("twice adds a point, but not slowly, elsewhere or on a point", () => {
    const click = (x_px: number, time_ms: number, y_px = 140) => [
      pointer("down", x_px, y_px, { time_ms }),
      pointer("up", x_px, y_px, { time_ms: time_ms + 50 }),
    ];
    expect(run([...click(75, 0), ...click(77, 200)]).acts.at(-1)).toMatchObject({
      kind: "add",
      at: { x_px: 77 },
    });
    expect(run([...click(75, 0, 240), ...click(77, 200, 240)]).kinds.at(-1)).toBe("add");
    expect(run([...click(75, 0), ...click(77, 600)]).kinds).not.toContain("add");
    expect(run([...click(75, 0), ...click(95, 200)]).kinds).not.toContain("add");
    expect(run([...click(50, 0, 60), ...click(50, 200, 60)]).kinds).not.toContain("add");
    expect(
      run([...click(75, 0), ...click(77, 200), ...click(77, 300)]).kinds.filter((k) => k === "add"),
    ).toHaveLength(1);
  });

  it("with the second button does nothing", () => {
    expect(run([pointer("down", 50, 60, { button: 2 }), pointer("up", 50, 60)]).acts).toEqual([]);
  });
});

describe("a box", () => {
  it("selects what lies in it, whichever corner it began at, with shift beside what was selected", () => {
    const from = [140, 90] as const;
    const events = [pointer("down", ...from), pointer("move", 40, 50), pointer("up", 40, 50)];
    expect(run(events, [0]).selected).toEqual([1, 2]);
    const more = events.map((e) => ({ ...e, shift: true }));
    expect(run(more, [0]).selected).toEqual([0, 1, 2]);
    expect(run(events).kinds.at(-1)).toBe("box-end");
    expect(run(events).kinds).not.toContain("begin");
  });

  it("that is cancelled gives the selection back", () => {
    const { state } = run([pointer("down", 140, 90), pointer("move", 40, 50)], [0]);
    expect(cancelled(state).acts).toEqual([{ kind: "box-end" }, { kind: "select", points: [0] }]);
  });
});

describe("panning", () => {
  it("is what the middle button, a held key and a finger on nothing do", () => {
    const ways = [{ button: 1 }, { held: true }, touch];
    for (const offset of ways) {
      const { acts } = run([pointer("down", 75, 140, offset), pointer("move", 95, 150, offset)]);
      expect(acts).toEqual([{ kind: "pan", offset: { dx_px: 20, dy_px: 10 } }]);
    }
    expect(run([pointer("down", 50, 60, { button: 1 }), pointer("move", 50, 90)]).kinds).toEqual(["pan"]);
  });
});

describe("two fingers", () => {
  const first = { ...touch, pointerId: 1 };
  const second = { ...touch, pointerId: 2 };

  it("pinch around their middle by the ratio of their distances", () => {
    const { acts } = run([
      pointer("down", 60, 140, first),
      pointer("down", 80, 140, second),
      pointer("move", 110, 140, second),
      pointer("move", 50, 140, first),
    ]);
    expect(acts.at(-1)).toEqual({
      kind: "pinch",
      offset: { dx_px: 10, dy_px: 0 },
      ratio: 3,
      around: { x_px: 70, y_px: 140 },
    });
  });

  it("pinch from where the first one is, however far it has come", () => {
    const { acts } = run([
      pointer("down", 40, 140, first),
      pointer("move", 60, 140, first),
      pointer("down", 80, 140, second),
      pointer("move", 100, 140, second),
    ]);
    expect(acts.at(-1)).toMatchObject({ kind: "pinch", ratio: 2, around: { x_px: 70 } });
  });

  it("take a drag back that the first one had begun", () => {
    const { kinds } = run([
      pointer("down", 50, 60, first),
      pointer("move", 50, 90, first),
      pointer("down", 80, 140, second),
    ]);
    expect(kinds).toEqual(["select", "begin", "shift", "cancel"]);
  });

  it("end as soon as one is lifted, and the other one does nothing more", () => {
    const { acts, state } = run([
      pointer("down", 60, 140, first),
      pointer("down", 80, 140, second),
      pointer("up", 60, 140, first),
      pointer("move", 150, 20, second),
    ]);
    expect(acts).toEqual([]);
    expect(state).toEqual(IDLE);
  });

  it("grip with more reach than a mouse", () => {
    expect(run([pointer("down", 50, 78, touch)]).selected).toEqual([1]);
    expect(run([pointer("down", 50, 78)]).selected).toEqual([]);
  });
});
