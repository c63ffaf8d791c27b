/** The graph of a program: nodes, arrows and their words, none on another; the same each time. */

import { shortly } from "../condition";
import { transitionsOf } from "../document";
import type { ProgramDocument, Transition } from "../document";
import { around, boxAround, centreOf, holds, onCubic, overlap, samplesOf } from "./geometry";
import type { Box, Cubic, Point } from "./geometry";
import { labelNear, labelOn, sizeOfText } from "./labels";
import { NODE, placesOf } from "./places";
import { loopsAt, routesBetween } from "./routes";
import type { Route } from "./routes";

/** A state's node. */
export interface GraphNode {
  readonly state: string;
  readonly box: Box;
}

/** A transition's arrow with its words. */
export interface GraphEdge {
  readonly state: string;
  readonly index: number;
  readonly to: string;
  readonly curve: Cubic;
  readonly lines: readonly string[];
  readonly label: Box;
  /** Where words that found no room on their arrow belong to; null if they stand on it. */
  readonly leader: Point | null;
}

/** Everything there is to draw, and the box around it. */
export interface Graph {
  readonly nodes: readonly GraphNode[];
  readonly edges: readonly GraphEdge[];
  readonly bounds: Box;
}

const SAMPLES = 17;
const MARGIN = 7;
/** How near two curves are that run beside each other. */
const BESIDE = 12;
const COST = { node: 90, near: 3, label: 30, far: 70 } as const;

/** Give the words on an arrow: its condition, its guard, and a note if it plays something. */
export function linesOf(way: Transition): readonly string[] {
  const first = `${shortly(way.when)}${way.signal ? " ♪" : ""}`;
  return way.only_if ? [first, `if ${shortly(way.only_if)}`] : [first];
}

/**
 * Lay out a program's graph.
 *
 * `moved` holds the centres of nodes that a person has put somewhere; the others stand in columns.
 * Ways to states that are not there are left out.
 */
export function graphOf(document: ProgramDocument, moved: ReadonlyMap<string, Point> = new Map()): Graph {
  const nodes = nodesOf(document, moved);
  const edges = new Router(nodes).route(document);
  const bounds = around([
    ...nodes.map((node) => node.box),
    ...edges.map((edge) => edge.label),
    ...edges.flatMap((edge) => samplesOf(edge.curve, SAMPLES).map((at) => ({ ...at, width: 0, height: 0 }))),
  ]);
  return { nodes, edges, bounds };
}

function nodesOf(document: ProgramDocument, moved: ReadonlyMap<string, Point>): GraphNode[] {
  const places = placesOf(document);
  return document.states.map(({ name }) => ({
    state: name,
    box: boxAround(moved.get(name) ?? places.get(name) ?? { x: 0, y: 0 }, NODE.width, NODE.height),
  }));
}

/** Takes arrows one by one, each by the route that costs least with what is there already. */
class Router {
  private readonly boxes: ReadonlyMap<string, Box>;
  private readonly labels: Box[] = [];
  private readonly curves: { readonly bounds: Box; readonly samples: readonly Point[] }[] = [];
  private readonly lanes = new Set<string>();

  constructor(private readonly nodes: readonly GraphNode[]) {
    this.boxes = new Map(nodes.map((node) => [node.state, node.box]));
  }

  route(document: ProgramDocument): GraphEdge[] {
    const ways = document.states.flatMap((state) =>
      transitionsOf(state).map((way, index) => ({ state: state.name, index, way })),
    );
    return ways
      .filter(({ way }) => this.boxes.has(way.to))
      .map(({ state, index, way }) => this.edge(state, index, way, ways.length));
  }

  private edge(state: string, index: number, way: Transition, count: number): GraphEdge {
    const pair = [state, way.to].sort().join("\n");
    const size = sizeOfText(linesOf(way));
    const best = this.best(this.offers(state, way.to, count), pair, size);
    this.lanes.add(`${pair}\n${best.route.lane}`);
    const samples = samplesOf(best.route.curve, SAMPLES);
    this.curves.push({ bounds: around(samples.map((at) => ({ ...at, width: 0, height: 0 }))), samples });
    const middle = onCubic(best.route.curve, 0.5);
    const label = best.label ?? labelNear(middle, size.width, size.height, this.taken());
    this.labels.push(label);
    const leader = best.label ? null : middle;
    return { state, index, to: way.to, curve: best.route.curve, lines: linesOf(way), label, leader };
  }

  private offers(state: string, to: string, count: number): readonly Route[] {
    const [from, target] = [this.boxes.get(state)!, this.boxes.get(to)!];
    const room = Math.min(count, 12) + 6;
    return state === to ? loopsAt(from, room) : routesBetween(from, target, room);
  }

  private best(
    offers: readonly Route[],
    pair: string,
    size: { readonly width: number; readonly height: number },
  ): { route: Route; label: Box | null } {
    let found = { route: offers[0]!, label: null as Box | null, cost: Infinity };
    const taken = this.taken();
    // what costs little to find out comes first: most routes are out of the question before it gets dear
    for (const route of offers) {
      if (this.lanes.has(`${pair}\n${route.lane}`) || route.detour >= found.cost) continue;
      const inner = samplesOf(route.curve, SAMPLES).slice(1, -1);
      let cost = route.detour + this.crossed(inner, pair);
      if (cost < found.cost) cost += COST.near * this.beside(inner);
      if (cost >= found.cost) continue;
      const label = labelOn(route.curve, size.width, size.height, taken);
      cost += label ? this.covered(label) : COST.far;
      if (cost < found.cost) found = { route, label, cost };
    }
    return found;
  }

  private taken(): readonly Box[] {
    return [...this.nodes.map((node) => node.box), ...this.labels];
  }

  /** What it costs to cross nodes and words. */
  private crossed(inner: readonly Point[], pair: string): number {
    const ends = pair.split("\n");
    const nodes = this.nodes.filter(
      (node) => !ends.includes(node.state) && inner.some((at) => holds(node.box, at, MARGIN)),
    ).length;
    const words = this.labels.filter((box) => inner.some((at) => holds(box, at))).length;
    return COST.node * nodes + COST.label * words;
  }

  /** Count the places at which a curve runs beside another. */
  private beside(inner: readonly Point[]): number {
    const near = (a: Point, b: Point): boolean => Math.abs(a.x - b.x) < BESIDE && Math.abs(a.y - b.y) < BESIDE;
    const own = around(inner.map((at) => ({ ...at, width: 0, height: 0 })));
    return this.curves
      .filter((held) => overlap(held.bounds, own, BESIDE))
      .reduce((sum, held) => sum + inner.filter((at) => held.samples.some((other) => near(at, other))).length, 0);
  }

  /** What words cost that stand on another arrow. */
  private covered(label: Box): number {
    const crossed = this.curves.filter((held) => held.samples.some((at) => holds(label, at))).length;
    return (COST.label / 2) * crossed;
  }
}

/** Count the pairs of nodes and words that lie on each other; for a layout of its own always 0. */
export function overlapsIn(graph: Graph): number {
  const boxes = [...graph.nodes.map((node) => node.box), ...graph.edges.map((edge) => edge.label)];
  return boxes.reduce(
    (sum, box, i) => sum + boxes.slice(i + 1).filter((other) => overlap(box, other)).length,
    0,
  );
}

/** Find the state whose node lies nearest to a place in a direction; null if there is none. */
export function neighbour(graph: Graph, state: string, dx: number, dy: number): string | null {
  const from = graph.nodes.find((node) => node.state === state);
  if (!from) return graph.nodes[0]?.state ?? null;
  const at = centreOf(from.box);
  const ahead = graph.nodes
    .map((node) => ({ node, x: centreOf(node.box).x - at.x, y: centreOf(node.box).y - at.y }))
    .map(({ node, x, y }) => ({ node, along: x * dx + y * dy, aside: Math.abs(x * dy - y * dx) }))
    .filter(({ along, aside }) => along > 1 && aside <= 2 * along)
    .sort((a, b) => a.along + 2 * a.aside - (b.along + 2 * b.aside));
  return ahead[0]?.node.state ?? null;
}
