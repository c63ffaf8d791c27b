/** The layout of a program's graph: dagre's, and routes of our own where a person has moved a state. */

import * as dagre from "@dagrejs/dagre";
import { shortly } from "./condition";
import { type ProgramDocument, type Transition, transitionsOf } from "./document";
import {
  type Box,
  borderPoint,
  boundsOf,
  boxAround,
  centreOf,
  contains,
  moveBox,
  overlap,
  type Point,
  splineThrough,
} from "./geometry";

/** A state's node. */
export interface GraphNode {
  readonly state: string;
  readonly box: Box;
}

/** A transition's arrow with its label. */
export interface GraphEdge {
  readonly state: string;
  readonly index: number;
  readonly to: string;
  /** Points of the arrow, from border to border; it is drawn as a spline through them. */
  readonly points: readonly Point[];
  readonly lines: readonly string[];
  readonly label: Box;
  /** The point of the arrow that a label beside it belongs to; null if the label is on the arrow. */
  readonly leader: Point | null;
}

/** Everything there is to draw, and the box around it. */
export interface Graph {
  readonly nodes: readonly GraphNode[];
  readonly edges: readonly GraphEdge[];
  readonly bounds: Box;
}

export const NODE = { width: 124, height: 54 } as const;
/** Width of a character and height of a line in the graph's font, on the safe side. */
const TEXT = { character: 7.3, line: 17, padding: 12 } as const;
const SPACING = { nodesep: 34, edgesep: 20, ranksep: 50 } as const;
/** Width over height of the frame that a graph is usually seen in. */
const ASPECT = 1.6;
/** Graphs up to this width read well from left to right; others go the way in which they are seen larger. */
const WIDE = 780;
const BEND = 44;
const RING = 22;

/** Return the lines of an arrow's label: its condition, with a note if it plays a signal, and its guard. */
function linesOf(transition: Transition): readonly string[] {
  const first = `${shortly(transition.when)}${transition.signal ? " ♪" : ""}`;
  return transition.only_if ? [first, `if ${shortly(transition.only_if)}`] : [first];
}

export function sizeOfText(lines: readonly string[]): { readonly width: number; readonly height: number } {
  const longest = Math.max(0, ...lines.map((line) => [...line].length));
  return {
    width: Math.ceil(longest * TEXT.character + TEXT.padding),
    height: TEXT.line * Math.max(1, lines.length) + 4,
  };
}

/** Lay out a program's graph; transitions to states that do not exist are left out. */
export function graphOf(document: ProgramDocument): Graph {
  const across = dagreLayout(document, "LR");
  return across.bounds.width > WIDE ? larger(across, dagreLayout(document, "TB")) : across;
}

function larger(a: Graph, b: Graph): Graph {
  const extent = ({ bounds }: Graph): number => Math.max(bounds.width, bounds.height * ASPECT);
  return extent(b) < extent(a) ? b : a;
}

function dagreLayout(document: ProgramDocument, rankdir: "LR" | "TB"): Graph {
  const layout = new dagre.Graph({ multigraph: true });
  layout.setGraph({ rankdir, ...SPACING });
  // dagre breaks cycles from the first node on: so every path leads away from the start
  const start = document.states.filter((state) => state.name === document.start);
  for (const { name } of [...start, ...document.states]) layout.setNode(name, { ...NODE });
  const edges = document.states.flatMap((state) =>
    transitionsOf(state)
      .map((transition, index) => ({
        state: state.name,
        index,
        to: transition.to,
        lines: linesOf(transition),
      }))
      .filter(({ to }) => layout.hasNode(to)),
  );
  for (const { state, index, to, lines } of edges)
    layout.setEdge(state, to, { ...sizeOfText(lines), labelpos: "c" }, String(index));
  dagre.layout(layout);
  const nodes = document.states.map(({ name }) => {
    const { x, y } = layout.node(name) as Point;
    return { state: name, box: boxAround({ x, y }, NODE.width, NODE.height) };
  });
  return bounded(
    nodes,
    edges.map((edge) => {
      const { points, x, y } = layout.edge(edge.state, edge.to, String(edge.index)) as Point & {
        readonly points: readonly Point[];
      };
      const { width, height } = sizeOfText(edge.lines);
      const label = boxAround({ x, y }, width, height);
      const isLoop = edge.state === edge.to;
      return {
        ...edge,
        points: isLoop ? loop(boxOf(nodes, edge.state), label) : points,
        label,
        leader: null,
      };
    }),
  );
}

/** Draw a loop from a node's side to the label that dagre has put beside it, and back. */
function loop(node: Box, label: Box): readonly Point[] {
  const [from, to] = [centreOf(node), centreOf(label)];
  const below = Math.abs(to.y - from.y) * NODE.width > Math.abs(to.x - from.x) * NODE.height;
  const [side, reach, room] = below
    ? [NODE.height / 2, to.y - from.y, NODE.width]
    : [NODE.width / 2, to.x - from.x, NODE.height];
  const out = Math.sign(reach);
  const half = Math.min(12 + (Math.abs(reach) - side) / 4, room / 2 - 6);
  const at = (along: number, across: number): Point =>
    below ? { x: from.x + across, y: from.y + along } : { x: from.x + along, y: from.y + across };
  const bend = side * out + 0.75 * (reach - side * out);
  return [at(side * out, -half), at(bend, -half), at(reach, 0), at(bend, half), at(side * out, half)];
}

function bounded(nodes: readonly GraphNode[], edges: readonly GraphEdge[]): Graph {
  const hulls = edges.flatMap((edge) =>
    splineThrough(edge.points)
      .flat()
      .map((at) => boxAround(at, 0, 0)),
  );
  const boxes = [...nodes.map((node) => node.box), ...edges.map((edge) => edge.label), ...hulls];
  return { nodes, edges, bounds: boundsOf(boxes) };
}

/** Move nodes to centres that a person has chosen, and route anew the arrows that this concerns. */
export function withMoved(graph: Graph, moved: ReadonlyMap<string, Point>): Graph {
  if (moved.size === 0) return graph;
  const nodes = graph.nodes.map(({ state, box }) => {
    const at = moved.get(state);
    return { state, box: at ? boxAround(at, NODE.width, NODE.height) : box };
  });
  const boxes = new Map(nodes.map((node) => [node.state, node.box]));
  const blocks = nodes.filter((node) => moved.has(node.state)).map((node) => node.box);
  const isKept = (edge: GraphEdge): boolean =>
    !moved.has(edge.state) &&
    !moved.has(edge.to) &&
    !blocks.some((box) => overlap(box, edge.label) || edge.points.some((at) => contains(box, at)));
  const taken = [...boxes.values(), ...graph.edges.filter(isKept).map((edge) => edge.label)];
  const lanes = new Map<string, number>();
  const edges = graph.edges.map((edge) => {
    if (isKept(edge)) return edge;
    const pair = [edge.state, edge.to].sort().join("\n");
    const lane = lanes.get(pair) ?? 0;
    lanes.set(pair, lane + 1);
    const [from, to] = [boxes.get(edge.state)!, boxes.get(edge.to)!];
    const routed =
      edge.state === edge.to
        ? shifted(edge, boxOf(graph.nodes, edge.state), from)
        : bent(edge, from, to, lane);
    const clear = withClearLabel(routed, taken);
    taken.push(clear.label);
    return clear;
  });
  return bounded(nodes, edges);
}

function boxOf(nodes: readonly GraphNode[], state: string): Box {
  return nodes.find((node) => node.state === state)!.box;
}

function shifted(edge: GraphEdge, before: Box, after: Box): GraphEdge {
  const by = { x: after.x - before.x, y: after.y - before.y };
  const points = edge.points.map((at) => ({ x: at.x + by.x, y: at.y + by.y }));
  return { ...edge, points, label: moveBox(edge.label, by) };
}

/** Route an arrow between two nodes; `lane` counts the arrows between them, on alternate sides. */
function bent(edge: GraphEdge, from: Box, to: Box, lane: number): GraphEdge {
  const [a, b] = [centreOf(from), centreOf(to)];
  const length = Math.hypot(b.x - a.x, b.y - a.y) || 1;
  // the same side for both directions, so that lanes of either never coincide
  const sign = edge.state < edge.to ? 1 : -1;
  const bend = sign * (lane % 2 === 0 ? 1 : -1) * BEND * (Math.floor(lane / 2) + 0.5);
  const middle = {
    x: (a.x + b.x) / 2 + ((b.y - a.y) / length) * bend,
    y: (a.y + b.y) / 2 - ((b.x - a.x) / length) * bend,
  };
  const label = boxAround(middle, edge.label.width, edge.label.height);
  return { ...edge, points: [borderPoint(from, middle), middle, borderPoint(to, middle)], label };
}

/** Move an edge's label, if it covers others, to the first free box on rings around its arrow's middle. */
function withClearLabel(edge: GraphEdge, taken: readonly Box[]): GraphEdge {
  const { width, height } = edge.label;
  const isFree = (box: Box): boolean => !taken.some((other) => overlap(box, other, 4));
  if (isFree(edge.label)) return edge;
  const leader = centreOf(edge.label);
  for (let ring = 1; ; ring += 1) {
    const steps = 8 * ring;
    for (let i = 0; i < steps; i += 1) {
      const angle = (2 * Math.PI * i) / steps;
      const at = {
        x: leader.x + ring * RING * Math.sin(angle),
        y: leader.y - ring * RING * Math.cos(angle),
      };
      const label = boxAround(at, width, height);
      if (isFree(label)) return { ...edge, label, leader };
    }
  }
}

/** Return the state whose node is nearest in a direction; null if there is none. */
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
