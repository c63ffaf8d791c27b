import { describe, expect, it } from "vitest";
import { type NudgeAct, type NudgeState, nudgeEnd, nudgeStep, STILL } from "../../src/tools/nudge";
import type { KeyRecord } from "../../src/tools/records";
import { key } from "./records";

function run(events: readonly KeyRecord[], axes: "x" | "y" = "y") {
  let state: NudgeState = STILL;
  const acts: NudgeAct[] = [];
  for (const event of events) {
    const step = nudgeStep(state, event, axes);
    state = step.state;
    acts.push(...step.acts);
  }
  return { state, acts };
}

const up = (name: string): KeyRecord => key(name, { kind: "up" });

describe("arrow keys", () => {
  it("move by 1 cN, ten with Shift, a tenth with Alt", () => {
    const force = (more: Partial<KeyRecord>) => run([key("ArrowUp", more)]).acts.at(-1);
    expect(force({})).toEqual({ kind: "nudge", by: { dx_mm: 0, dforce_cN: 1 } });
    expect(force({ shift: true })).toEqual({ kind: "nudge", by: { dx_mm: 0, dforce_cN: 10 } });
    expect(force({ alt: true })).toEqual({ kind: "nudge", by: { dx_mm: 0, dforce_cN: 0.1 } });
  });

  it("move a handle by 0.05 mm and nothing upward", () => {
    const { acts } = run([key("ArrowLeft"), key("ArrowUp")], "x");
    expect(acts).toEqual([{ kind: "begin" }, { kind: "nudge", by: { dx_mm: -0.05, dforce_cN: 0 } }]);
  });

  it("are one undo step from the first key down to the last key up, and tell the total way", () => {
    const { acts, state } = run([
      key("ArrowUp"),
      key("ArrowUp"),
      key("ArrowDown"),
      up("ArrowUp"),
      up("ArrowDown"),
    ]);
    expect(acts.map((a) => a.kind)).toEqual(["begin", "nudge", "nudge", "nudge", "commit"]);
    expect(acts[2]).toEqual({ kind: "nudge", by: { dx_mm: 0, dforce_cN: 2 } });
    expect(acts[3]).toEqual({ kind: "nudge", by: { dx_mm: 0, dforce_cN: 1 } });
    expect(state).toEqual(STILL);
  });

  it("a hundred fine steps are exactly ten coarse ones", () => {
    const fine = run(Array.from({ length: 100 }, () => key("ArrowUp", { alt: true }))).acts.at(-1);
    const coarse = run(Array.from({ length: 10 }, () => key("ArrowUp"))).acts.at(-1);
    expect(fine).toEqual(coarse);
  });

  it("are taken back by Escape and closed when the focus leaves", () => {
    expect(run([key("ArrowUp"), key("Escape")]).acts.at(-1)).toEqual({ kind: "cancel" });
    expect(nudgeEnd(run([key("ArrowUp")]).state).acts).toEqual([{ kind: "commit" }]);
    expect(nudgeEnd(STILL).acts).toEqual([]);
  });

  it("leave alone what is not theirs", () => {
    expect(
      run([key("a"), key("Escape"), key("ArrowLeft"), key("ArrowUp", { ctrl: true }), up("ArrowUp")]).acts,
    ).toEqual([]);
  });
});
