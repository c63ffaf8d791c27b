import { describe, expect, it } from "vitest";
import {
  condition,
  firstCondition,
  inWords,
  KINDS,
  kindOf,
  shortly,
  transitionInWords,
  valueProblem,
} from "../../src/programs/condition";
import type { ProgramDocument } from "../../src/programs/document";
import { freeName, nameProblem, transitionsOf } from "../../src/programs/document";
import * as edits from "../../src/programs/edits";
import * as parts from "../../src/programs/edits_parts";
import { choiceAt, isThere, pathOf } from "../../src/programs/path";
import { problemsOf } from "../../src/programs/problems";
import { flatSurface } from "../../src/programs/surface";
import { randomProgram, SHIPPED, seeded } from "./shipped";

const [button, dwell] = [SHIPPED[0]!, SHIPPED[1]!];

it("begins an arrow from the start beyond half the travel, another above a quarter of it", () => {
  const [travel_mm, other] = [4, button.states.find((state) => state.name !== button.start)!.name];
  const held = { ...button, travel_mm };
  expect(firstCondition(held, held.start)).toEqual(condition("deeper_than_mm", 2));
  expect(firstCondition(held, other)).toEqual(condition("shallower_than_mm", 1));
});

/** Names that a document refers to and that are not there, or are there twice. */
function dangling(document: ProgramDocument): string[] {
  const names = (list: readonly { readonly name: string }[] | undefined): string[] =>
    (list ?? []).map((held) => held.name);
  const [states, surfaces, signals] = [
    names(document.states),
    names(document.surfaces),
    names(document.signals),
  ];
  const places = document.states.flatMap((state) => [
    ...[state.press, state.release].filter((name) => !surfaces.includes(name)),
    ...[state.enter_signal, state.repeat_signal].filter((name) => name && !signals.includes(name)),
    ...transitionsOf(state)
      .filter((transition) => !states.includes(transition.to))
      .map((transition) => transition.to),
    ...transitionsOf(state)
      .filter((transition) => transition.signal && !signals.includes(transition.signal))
      .map((transition) => transition.signal),
  ]);
  const events = (document.vibrations ?? []).flatMap((event) => [
    ...(signals.includes(event.signal) ? [] : [event.signal]),
    ...(event.states ?? []).filter((name) => !states.includes(name)),
  ]);
  const twice = [states, surfaces, signals].flatMap((list) =>
    list.filter((name, i) => list.indexOf(name) !== i),
  );
  return [
    ...places,
    ...events,
    ...twice,
    ...(states.includes(document.start) ? [] : [document.start]),
  ] as string[];
}

describe("edits of states", () => {
  it("leave the document that they were given as it was", () => {
    const before = JSON.stringify(dwell);
    edits.renameState(dwell, "up", "top");
    edits.removeState(dwell, "down");
    edits.addState(dwell);
    expect(JSON.stringify(dwell)).toBe(before);
  });

  it("rename a state wherever it is named", () => {
    const renamed = edits.renameState(dwell, "down", "held");
    expect(dangling(renamed)).toEqual([]);
    expect(JSON.stringify(renamed)).not.toContain('"down"');
    expect(edits.renameState(renamed, "held", "down")).toEqual(dwell);
  });

  it("remove a state with the ways to it, and never the last one", () => {
    const left = edits.removeState(dwell, dwell.start);
    expect(left.states).toHaveLength(dwell.states.length - 1);
    expect(dangling(left)).toEqual([]);
    const one = edits.removeState(left, left.states[1]!.name);
    expect(edits.removeState(one, one.states[0]!.name)).toBe(one);
  });

  it("add a state that feels like another, under a name of its own", () => {
    const [first, name] = edits.addState(button, "down");
    const [second, other] = edits.addState(first, "down");
    expect([name, other]).toEqual(["state", "state 2"]);
    expect(second.states[2]!.press).toBe(button.states[1]!.press);
    expect(dangling(second)).toEqual([]);
  });

  it("copy a state with what it plays, and its loops to itself", () => {
    const looped = edits.addTransition(dwell, "dwelling", "dwelling", condition("after_ms", 9));
    const [copied, name] = edits.duplicateState(looped, "dwelling");
    const fresh = copied.states.find((state) => state.name === name)!;
    expect(fresh.repeat_signal).toBe("tick");
    expect(transitionsOf(fresh).at(-1)!.to).toBe(name);
  });

  it("let the fields of a repeat and of a ramp go together", () => {
    const silent = edits.changeState(dwell, "dwelling", { repeat_signal: null });
    expect(silent.states[2]).toMatchObject({ repeat_signal: null, repeat_ms: 0 });
    const ticking = edits.changeState(dwell, "up", { repeat_signal: "tick" });
    expect(ticking.states[0]!.repeat_ms).toBeGreaterThan(0);
    const ramp = edits.changeState(dwell, "up", { bias_ms: 0, bias_end_cN: 5 });
    expect(ramp.states[0]!.bias_end_cN).toBe(0);
  });
});

describe("edits of transitions", () => {
  it("add, change, order and remove ways", () => {
    const added = edits.addTransition(button, "up", "up", condition("after_ms", 100));
    expect(transitionsOf(added.states[0]!)).toHaveLength(2);
    const first = edits.reorderTransition(added, "up", 1, -1);
    expect(transitionsOf(first.states[0]!)[0]!.when).toEqual({ after_ms: 100 });
    expect(edits.reorderTransition(first, "up", 0, -1)).toEqual(first);
    const changed = edits.changeTransition(first, "up", 0, { only_if: condition("slower_than_mm_s", 5) });
    expect(transitionsOf(changed.states[0]!)[0]!.only_if).toEqual({ slower_than_mm_s: 5 });
    expect(edits.removeTransition(first, "up", 0)).toEqual(button);
  });

  it("let a way begin elsewhere", () => {
    const [moved, index] = edits.moveTransitionTo(button, "up", 0, "down");
    expect(transitionsOf(moved.states[0]!)).toHaveLength(0);
    expect(transitionsOf(moved.states[1]!)[index]!.to).toBe("down");
  });
});

describe("edits of surfaces and signals", () => {
  it("give a state a surface of its own before it is changed", () => {
    const [owned, name] = parts.ownSurface(button, "up", "press");
    expect(name).toBe("up press");
    const changed = parts.replaceSurface(owned, name, flatSurface("any", 12));
    expect(changed.states[1]!.press).toBe(button.states[1]!.press);
    expect(parts.usesOfSurface(changed, name)).toEqual([{ state: "up", stroke: "press" }]);
    expect(parts.ownSurface(changed, "up", "press")).toEqual([changed, name]);
  });

  it("copy forces between states and strokes", () => {
    const copied = parts.copySurface(
      button,
      { state: "up", stroke: "press" },
      { state: "down", stroke: "release" },
    );
    const name = copied.states[1]!.release;
    const source = button.surfaces.find((surface) => surface.name === button.states[0]!.press)!;
    expect(copied.surfaces.find((surface) => surface.name === name)!.force_cN).toEqual(source.force_cN);
    expect(dangling(copied)).toEqual([]);
  });

  it("remove a surface only when nobody feels it", () => {
    expect(parts.removeSurface(button, "press")).toBe(button);
    const [more, name] = parts.addSurface(button, flatSurface("push", 5));
    expect(parts.removeSurface(more, name)).toEqual(button);
  });

  it("remove and rename signals wherever they are played", () => {
    expect(dangling(parts.removeSignal(dwell, "tick"))).toEqual([]);
    expect(dangling(parts.renameSignal(dwell, "tick", "tock"))).toEqual([]);
    expect(JSON.stringify(parts.renameSignal(dwell, "tick", "tock"))).not.toContain('"tick"');
  });
});

describe("any row of edits", () => {
  it("leaves no name that nobody has, for two hundred edits of five random programs", () => {
    for (let seed = 0; seed < 5; seed += 1) {
      const random = seeded(seed);
      let document: ProgramDocument = { ...randomProgram(seed, 4, 9), signals: dwell.signals ?? [] };
      for (let i = 0; i < 200; i += 1) {
        document = edited(document, random);
        expect(dangling(document)).toEqual([]);
      }
    }
  });
});

function edited(document: ProgramDocument, random: () => number): ProgramDocument {
  const some = <T>(list: readonly T[]): T => list[Math.floor(random() * list.length)]!;
  const [a, b] = [some(document.states).name, some(document.states).name];
  const signal = document.signals?.length ? some(document.signals).name : null;
  const choices: (() => ProgramDocument)[] = [
    () => edits.addState(document, a)[0],
    () => edits.duplicateState(document, a)[0],
    () => edits.removeState(document, a),
    () =>
      edits.renameState(
        document,
        a,
        freeName(
          "renamed",
          document.states.map((state) => state.name),
        ),
      ),
    () => edits.addTransition(document, a, b, condition(some(KINDS).kind)),
    () => edits.removeTransition(document, a, 0),
    () => edits.moveTransitionTo(document, a, 0, b)[0],
    () => edits.setStart(document, b),
    () => parts.ownSurface(document, a, "press")[0],
    () => parts.copySurface(document, { state: a, stroke: "press" }, { state: b, stroke: "release" }),
    () => (signal ? parts.addVibration(document, { signal, at_mm: 1, states: [a] }) : document),
    () => (signal && random() < 0.2 ? parts.removeSignal(document, signal) : document),
    () => (signal ? edits.changeState(document, a, { repeat_signal: signal }) : document),
    () =>
      parts.addSignal(document, {
        name: "tick",
        duration_s: 0.01,
        modes: [{ frequency_Hz: 200, amplitude_m_s2: 5, decay_1_s: 200 }],
      })[0],
  ];
  return some(choices)();
}

describe("names", () => {
  it("are found that nobody has", () => {
    expect(freeName("a", [])).toBe("a");
    expect(freeName("a", ["a", "a 2"])).toBe("a 3");
    expect(freeName("a 2", ["a 2"])).toBe("a");
    expect([...freeName("x".repeat(60), [])].length).toBeLessThanOrEqual(40);
  });

  it("are refused as the file refuses them", () => {
    for (const bad of ["", " ", " a", "a ", "x".repeat(41), "a\nb", "a\u0007"])
      expect(nameProblem(bad, [])).toBeTruthy();
    expect(nameProblem("a", ["a"])).toContain("already");
    expect(nameProblem("half pressed – ½", ["a"])).toBeNull();
  });
});

describe("conditions", () => {
  it("of every kind are described shortly and in words, with their unit", () => {
    for (const known of KINDS) {
      const built = condition(known.kind, known.first === true ? undefined : 7);
      expect(kindOf(built)).toBe(known);
      expect(valueProblem(built)).toBeNull();
      for (const words of [shortly(built), inWords(built)]) {
        if (known.first !== true) expect(words).toContain("7");
        expect(words).toContain(known.unit);
      }
    }
  });

  it("are refused beyond their bounds, and where a whole number is needed", () => {
    expect(valueProblem(condition("host_event", 32))).toContain("31");
    expect(valueProblem(condition("after_ms", 1.5))).toContain("whole");
    expect(valueProblem(condition("deeper_than_mm", Number.NaN))).toBeTruthy();
  });

  it("make a sentence", () => {
    expect(transitionInWords({ deeper_than_mm: 1.2 }, null)).toBe("when the cap is deeper than 1.2 mm");
    expect(transitionInWords({ always: true }, { faster_than_mm_s: 50 }, "continuous")).toBe(
      "at the next tick, but only while the speed at that instant is above 50 mm/s",
    );
  });
});

describe("places", () => {
  it("lead there and back", () => {
    for (const path of ["states[1]", "states[1].transitions[0]", "surfaces[0]", "signals[0]"])
      expect(pathOf(dwell, choiceAt(dwell, path))).toBe(path);
    expect(choiceAt(dwell, "states[99]").kind).toBe("program");
    expect(choiceAt(dwell, "states[0].transitions[9]")).toEqual({ kind: "state", state: "up" });
  });

  it("are missed once they are gone", () => {
    const choice = choiceAt(dwell, "states[1].transitions[0]");
    expect(isThere(dwell, choice)).toBe(true);
    expect(isThere(edits.removeState(dwell, "down"), choice)).toBe(false);
  });
});

describe("problems", () => {
  it("are none in the shipped programs", () => {
    for (const document of SHIPPED) expect(problemsOf(document)).toEqual([]);
  });

  it("are reported with their place", () => {
    const far = edits.changeTransition(button, "down", 0, { when: { host_event: 40 } });
    expect(problemsOf(far).map((found) => found.path)).toEqual(["states[1].transitions[0]"]);
    expect(problemsOf({ ...button, travel_mm: 9 })[0]!.path).toBe("travel_mm");
    expect(problemsOf(edits.changeState(button, "up", { fade_ms: 2.5 }))[0]!.path).toBe("states[0]");
    expect(problemsOf(randomProgram(1, 17, 0))[0]!.reason).toContain("17 states");
    const twisted = { ...button.surfaces[0]!, displacement_mm: [1, 0], force_cN: [[1, 2]] };
    expect(problemsOf({ ...button, surfaces: [twisted] })[0]!.path).toBe("surfaces[0]");
  });
});
