/** What is said of the parts of a graph, and how arrows end. */

import type { ProgramFinding, Severity } from "../../net/messages";
import { transitionInWords } from "../../programs/condition";
import { type ProgramDocument, type State, stateNamed, transitionsOf } from "../../programs/document";
import type { Point } from "../../programs/geometry";
import type { Graph, GraphEdge, GraphNode } from "../../programs/graph_layout";
import { type Choice, pathOf } from "../../programs/path";

export type Flaw = Severity | "";
export const MARKS: Readonly<Record<Flaw, string>> = { refused: "✕", warning: "!", "": "" };
const LONGEST = 15;
const HEAD = { length: 10, half: 5 } as const;

/** Return a name of what can be focused, the same before and after an edit. */
export function keyOf(choice: Choice): string {
  if (choice.kind === "state") return `state ${choice.state}`;
  return choice.kind === "transition" ? `way ${choice.index} ${choice.state}` : "";
}

/** A node or an arrow with what is said of it. */
export interface Part {
  readonly key: string;
  readonly choice: Choice;
  readonly state: State;
  readonly node?: GraphNode;
  readonly edge: GraphEdge | undefined;
}

/** Return every node followed by its arrows. */
export function partsOf(graph: Graph, document: ProgramDocument): readonly Part[] {
  return graph.nodes.flatMap((node) => {
    const state = stateNamed(document, node.state);
    if (!state) return [];
    const choice: Choice = { kind: "state", state: state.name };
    const edges = graph.edges.filter((edge) => edge.state === node.state);
    return [
      { key: keyOf(choice), choice, state, node, edge: undefined },
      ...edges.map((edge) => {
        const way: Choice = { kind: "transition", state: state.name, index: edge.index };
        return { key: keyOf(way), choice: way, state, edge };
      }),
    ];
  });
}

/** How bad what was found of a part is: in a state also what was found in it. */
export function flawOf(
  document: ProgramDocument,
  findings: readonly ProgramFinding[],
  { choice }: Part,
): Flaw {
  const path = pathOf(document, choice);
  const found = findings.filter(
    (finding) => finding.path === path || (choice.kind === "state" && finding.state === choice.state),
  );
  if (found.some(({ severity }) => severity === "refused")) return "refused";
  return found.length > 0 ? "warning" : "";
}

/** Say what a part is; what is seen comes first, so that speech input finds it. */
export function labelOf({ state, edge }: Part, start: boolean, flaw: Flaw, live: boolean): string {
  const said = edge
    ? edgeWords(edge, state)
    : [...nodeWords(state, flaw), start ? "the start" : "", waysOut(state)];
  return [...said, flaw, live ? "the press is here" : ""].filter(Boolean).join(", ");
}

function nodeWords(state: State, flaw: Flaw): readonly string[] {
  return [`${short(state.name)} ${notes(state)} ${MARKS[flaw]}`.trim(), `state ${state.name}`];
}

function waysOut(state: State): string {
  const { length } = transitionsOf(state);
  return length === 1 ? "1 transition out" : `${length || "no"} transitions out`;
}

function edgeWords(edge: GraphEdge, state: State): readonly string[] {
  const transition = transitionsOf(state)[edge.index];
  const when = transition ? transitionInWords(transition.when, transition.only_if, state.velocity) : "";
  return [edge.lines.join(" "), `from ${edge.state} to ${edge.to} ${when}`];
}

export function notes(state: State): string {
  const plays = state.enter_signal || state.repeat_signal ? " ♪" : "";
  const bias = state.bias_cN || state.bias_end_cN ? " ±" : "";
  return `key ${state.key ?? 0}${plays}${bias}`;
}

export function short(name: string): string {
  const letters = [...name];
  return letters.length > LONGEST ? `${letters.slice(0, LONGEST - 1).join("")}…` : name;
}

/** Return the path of the head of an arrow through points. */
export function headOf(points: readonly Point[]): string {
  const [before, end] = points.slice(-2) as [Point, Point];
  const length = Math.hypot(end.x - before.x, end.y - before.y) || 1;
  const [dx, dy] = [(end.x - before.x) / length, (end.y - before.y) / length];
  const back = { x: end.x - dx * HEAD.length, y: end.y - dy * HEAD.length };
  const [x, y] = [dy * HEAD.half, dx * HEAD.half];
  return `M${end.x} ${end.y}L${back.x - x} ${back.y + y}L${back.x + x} ${back.y - y}Z`;
}
