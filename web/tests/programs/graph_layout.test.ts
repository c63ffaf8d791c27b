import { describe, expect, it } from "vitest";
import { type ProgramDocument, transitionsOf } from "../../src/programs/document";
import { centreOf, contains, overlap, type Point, splineThrough } from "../../src/programs/geometry";
import { type Graph, graphOf, neighbour, sizeOfText, withMoved } from "../../src/programs/graph_layout";
import { randomProgram, SHIPPED } from "./shipped";

/** Count the pairs of nodes and labels that cover each other. */
function overlapsIn(graph: Graph): number {
  const boxes = [...graph.nodes.map((node) => node.box), ...graph.edges.map((edge) => edge.label)];
  return boxes.reduce(
    (sum, box, i) => sum + boxes.slice(i + 1).filter((other) => overlap(box, other)).length,
    0,
  );
}

/** Sample the drawn arrow through points. */
function samples(points: readonly Point[]): Point[] {
  return splineThrough(points).flatMap(([a, b, c, d]) =>
    Array.from({ length: 17 }, (_, i) => {
      const [s, t] = [1 - i / 16, i / 16];
      const mix = (key: "x" | "y") =>
        s * s * s * a[key] + 3 * s * s * t * b[key] + 3 * s * t * t * c[key] + t * t * t * d[key];
      return { x: mix("x"), y: mix("y") };
    }),
  );
}

const RANDOM = Array.from({ length: 40 }, (_, seed) => randomProgram(seed, 1 + (seed % 32), (seed * 7) % 49));
const GRAPHS = [...SHIPPED, ...RANDOM].map((document) => [document, graphOf(document)] as const);
const transitions = (document: ProgramDocument): number =>
  document.states.reduce((sum, state) => sum + transitionsOf(state).length, 0);

describe("the layout of a program's graph", () => {
  it.each(SHIPPED.map((document) => [document.name, document] as const))(
    "has no words and no node of %s on each other, and an arrow for each way",
    (_, document) => {
      const graph = graphOf(document);
      expect(graph.nodes.map((node) => node.state)).toEqual(document.states.map((state) => state.name));
      expect(graph.edges).toHaveLength(transitions(document));
      expect(overlapsIn(graph)).toBe(0);
      expect(graph.edges.every((edge) => edge.leader === null)).toBe(true);
    },
  );

  it("has no words and no node of forty random programs to 32 states on each other", () => {
    for (const [document, graph] of GRAPHS)
      expect([document.name, overlapsIn(graph)]).toEqual([document.name, 0]);
  });

  it("is the same each time", () => {
    for (const document of RANDOM.slice(0, 8)) expect(graphOf(document)).toEqual(graphOf(document));
  });

  it("has the start on the left of, or above, every state that it leads to", () => {
    for (const document of SHIPPED) {
      const graph = graphOf(document);
      const start = graph.nodes.find((node) => node.state === document.start)!.box;
      const [left, top] = [start.x + start.width, start.y + start.height];
      for (const { state, box } of graph.nodes)
        expect(state === document.start || box.x > left || box.y > top).toBe(true);
    }
  });

  it("lets every arrow begin at its state and end at the one it leads to", () => {
    for (const [, graph] of GRAPHS) {
      const boxes = new Map(graph.nodes.map((node) => [node.state, node.box]));
      for (const edge of graph.edges) {
        expect(contains(boxes.get(edge.state)!, edge.points[0]!, 2)).toBe(true);
        expect(contains(boxes.get(edge.to)!, edge.points.at(-1)!, 2)).toBe(true);
      }
    }
  });

  it("keeps arrows between the same two states apart", () => {
    const many: ProgramDocument = {
      ...randomProgram(1, 2, 0),
      states: ["state 0", "state 1"].map((name, i) => ({
        name,
        press: "push",
        release: "push",
        transitions: Array.from({ length: 5 }, (_, n) => ({ to: `state ${1 - i}`, when: { after_ms: n } })),
      })),
    };
    const middles = graphOf(many).edges.map((edge) => centreOf(edge.label).y);
    middles.sort((a, b) => a - b);
    for (let i = 1; i < middles.length; i += 1) expect(middles[i]! - middles[i - 1]!).toBeGreaterThan(20);
  });

  it("draws a way back to the same state as a loop outside of the node", () => {
    const loops = { ...randomProgram(3, 1, 6) };
    const graph = graphOf(loops);
    expect(graph.edges).toHaveLength(6);
    for (const edge of graph.edges)
      expect(contains(graph.nodes[0]!.box, edge.points[edge.points.length >> 1]!)).toBe(false);
    expect(overlapsIn(graph)).toBe(0);
  });

  it("leads arrows of the shipped programs past nodes that they have nothing to do with", () => {
    for (const document of SHIPPED) {
      const graph = graphOf(document);
      for (const edge of graph.edges)
        for (const node of graph.nodes.filter((node) => node.state !== edge.state && node.state !== edge.to))
          expect(samples(edge.points).some((at) => contains(node.box, at))).toBe(false);
    }
  });

  it("lets a person put a node anywhere, and its words still keep clear", () => {
    const document = SHIPPED.find((held) => held.name === "multi-level")!;
    const name = document.states[1]!.name;
    const graph = withMoved(graphOf(document), new Map([[name, { x: 900, y: 333 }]]));
    expect(centreOf(graph.nodes[1]!.box)).toEqual({ x: 900, y: 333 });
    expect(overlapsIn(graph)).toBe(0);
  });

  it("leaves out a way to a state that is not there, and stands without a known start", () => {
    const lost = randomProgram(5, 3, 0);
    const state = { ...lost.states[0]!, transitions: [{ to: "nowhere", when: { always: true as const } }] };
    const graph = graphOf({ ...lost, start: "nowhere", states: [state, ...lost.states.slice(1)] });
    expect(graph.edges).toEqual([]);
    expect(graph.nodes).toHaveLength(3);
    expect(overlapsIn(graph)).toBe(0);
  });

  it("finds the next node in a direction, and none where there is none", () => {
    const graph = graphOf(SHIPPED[0]!);
    expect(neighbour(graph, "up", 1, 0)).toBe("down");
    expect(neighbour(graph, "down", -1, 0)).toBe("up");
    expect(neighbour(graph, "up", -1, 0)).toBeNull();
  });

  it("holds as much text as it is told", () => {
    expect(sizeOfText(["x > 1.2 mm", "if v < 3 mm/s"]).width).toBeGreaterThan(sizeOfText(["x"]).width);
  });
});
