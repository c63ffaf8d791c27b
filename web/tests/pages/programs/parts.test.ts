// @vitest-environment jsdom
import { flushSync, mount, unmount } from "svelte";
import { afterEach, beforeEach, describe, expect, it } from "vitest";
import { linear } from "../../../src/draw/scale";
import type { ProgramFinding } from "../../../src/net/messages";
import { handlesOf, nearestHandle } from "../../../src/pages/programs/forces_points";
import GraphParts from "../../../src/pages/programs/GraphParts.svelte";
import { readPositions } from "../../../src/pages/programs/positions";
import { stepOf, wordsOf } from "../../../src/pages/programs/recipe";
import { condition, eventsOf } from "../../../src/programs/condition";
import { addTransition } from "../../../src/programs/edits";
import { graphOf } from "../../../src/programs/graph_layout";
import type { Choice } from "../../../src/programs/path";
import { lineSurface } from "../../../src/programs/surface";
import { signal } from "../../../src/ui";
import { SHIPPED } from "../../programs/shipped";

const BUTTON = SHIPPED[0]!;

describe("a drawn graph", () => {
  const choice = signal<Choice>({ kind: "state", state: "up" });
  const findings = signal<readonly ProgramFinding[]>([]);
  const live = signal<string | null>(null);
  let scene: SVGSVGElement;
  let made: object;
  const found = (state: string) => scene.querySelector(`.node[data-state=${state}]`)!;

  beforeEach(() => {
    scene = document.createElementNS("http://www.w3.org/2000/svg", "svg");
    const props = {
      graph: graphOf(BUTTON),
      program: BUTTON,
      get choice() {
        return choice();
      },
      get findings() {
        return findings();
      },
      get live() {
        return live();
      },
    };
    made = mount(GraphParts, { target: scene, props });
    flushSync();
  });
  afterEach(() => unmount(made));

  it("tells every state and every way in words that begin with what is seen", () => {
    const buttons = [...scene.querySelectorAll("[role=button]")];
    expect(buttons).toHaveLength(4);
    for (const held of buttons) {
      const seen = held.textContent!.replace(/\s+/g, " ").trim();
      expect(held.getAttribute("aria-label")!.startsWith(seen)).toBe(true);
      expect(held.getAttribute("tabindex")).toBe("0");
    }
  });

  it("follows what is chosen, where a press is and what was found, without being drawn again", () => {
    const [up, down] = [found("up"), found("down")];
    expect([up, down].map((held) => held.getAttribute("aria-pressed"))).toEqual(["true", "false"]);
    choice.set({ kind: "state", state: "down" });
    live.set("down");
    const finding = {
      severity: "refused",
      path: "states[1]",
      state: "down",
      place: "",
      reason: "",
      remedy: "",
      at_mm: null,
    } as const;
    findings.set([finding]);
    expect([up, down].map((held) => held.getAttribute("aria-pressed"))).toEqual(["false", "true"]);
    expect([...down.classList]).toEqual(expect.arrayContaining(["live", "refused"]));
    expect(down.getAttribute("aria-label")).toContain("the press is here");
    expect(up.getAttribute("class")).not.toMatch(/live|refused/);
    expect([up, down].every((held) => scene.contains(held))).toBe(true);
  });
});

describe("the numbers of a recipe", () => {
  it("are named by what stands before their unit", () => {
    expect(wordsOf("top_dead_mm")).toEqual({ label: "Top dead", unit: "mm" });
    expect(wordsOf("fastest_mm_s")).toEqual({ label: "Fastest", unit: "mm/s" });
    expect(wordsOf("stiffening_per_m_s")).toEqual({ label: "Stiffening", unit: "per m/s" });
    expect(wordsOf("event")).toEqual({ label: "Event", unit: "" });
  });

  it("go in steps that suit their range", () => {
    expect(stepOf({ name: "levels", default: 3, whole: true, low: 1, high: 8 })).toBe(1);
    expect(stepOf({ name: "drop_ms", default: 60, whole: true, low: 5, high: 1000 })).toBe(10);
    expect(stepOf({ name: "press_mm", default: 0.15, whole: false, low: 0.01, high: 1.8 })).toBe(0.05);
  });
});

describe("points to pull", () => {
  const many = lineSurface(
    "many",
    Array.from({ length: 200 }, (_, i) => [i / 50, i] as const),
  );
  const view = {
    x: linear({ low: 0, high: 4 }, 0, 400),
    y: linear({ low: 0, high: 200 }, 200, 0),
    box: { left: 0, top: 0, width: 400, height: 200 },
    width_px: 400,
    height_px: 200,
  };

  it("are all of a few, and some of many with both ends", () => {
    const few = lineSurface("few", [
      [0, 1],
      [1, 2],
      [2, 3],
    ]);
    expect(handlesOf(few)).toEqual([0, 1, 2]);
    const handles = handlesOf(many);
    expect([handles[0], handles.at(-1)]).toEqual([0, 199]);
    expect(handles.length).toBeLessThan(30);
    expect([...new Set(handles)]).toEqual(handles);
  });

  it("are found near a hand and not far from it", () => {
    const column = handlesOf(many)[5]!;
    const at = {
      x_px: view.x.px(many.displacement_mm[column]!) + 3,
      y_px: view.y.px(many.force_cN[0]![column]!) - 4,
    };
    expect(nearestHandle(many, 0, view, at, 22)).toBe(column);
    expect(nearestHandle(many, 0, view, { x_px: 0, y_px: 0 }, 22)).toBeNull();
  });
});

describe("places that a browser remembers", () => {
  it("are read, and whatever is none is left out", () => {
    expect([
      ...readPositions('[["up",{"x":1,"y":2}],["down",{"x":null,"y":2}],[3,{"x":1,"y":2}],7,["lost"]]'),
    ]).toEqual([["up", { x: 1, y: 2 }]]);
    for (const text of [null, "", "{", "{}", "null", "3"]) expect(readPositions(text).size).toBe(0);
  });
});

describe("host events that a program waits for", () => {
  it("are listed once each, rising", () => {
    const waits = [7, 3, 7].reduce(
      (held, n) => addTransition(held, "up", "down", condition("host_event", n)),
      BUTTON,
    );
    expect(eventsOf(waits)).toEqual([3, 7]);
    expect(eventsOf(BUTTON)).toEqual([]);
  });
});
