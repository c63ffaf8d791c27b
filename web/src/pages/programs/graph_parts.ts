/** What a graph is drawn of: nodes, arrows and their words, each a button for keys and screen readers. */

import type { ProgramFinding } from "../../net/messages";
import { transitionInWords } from "../../programs/condition";
import { type ProgramDocument, type State, transitionsOf } from "../../programs/document";
import { type Box, centreOf, type Point, svgPath } from "../../programs/geometry";
import type { Graph, GraphEdge, GraphNode } from "../../programs/graph_layout";
import { type Choice, pathOf } from "../../programs/path";
import { effect, svg } from "../../ui";

/** Everything that a drawing shows; functions follow signals. */
export interface Drawn {
  readonly graph: Graph;
  readonly document: ProgramDocument;
  readonly choice: () => Choice;
  readonly findings: () => readonly ProgramFinding[];
  readonly live: () => string | null;
}

/** Return a name to what can be focused, the same before and after it is drawn again. */
export function keyOf(choice: Choice): string {
  if (choice.kind === "state") return `state ${choice.state}`;
  return choice.kind === "transition" ? `way ${choice.index} ${choice.state}` : "";
}

const LONGEST = 15;
const HEAD = { length: 10, half: 5 } as const;

/** Make the elements of a graph: arrows below, nodes above, each node followed by its arrows' words. */
export function drawnGraph(drawn: Drawn): readonly SVGElement[] {
  const arrows = drawn.graph.edges.map((edge) => arrow(drawn, edge));
  const buttons = drawn.graph.nodes.flatMap((node) => [
    nodeButton(drawn, node),
    ...drawn.graph.edges.filter((edge) => edge.state === node.state).map((edge) => edgeButton(drawn, edge)),
  ]);
  return [...arrows, ...buttons];
}

function chosen(drawn: Drawn, key: string): boolean {
  return keyOf(drawn.choice()) === key;
}

/** How bad what was found at a path is: itself or in it. */
function flaw(drawn: Drawn, path: string, state: string | null): "refused" | "warning" | "" {
  const found = drawn
    .findings()
    .filter((finding) => finding.path === path || (state !== null && finding.state === state));
  if (found.some((finding) => finding.severity === "refused")) return "refused";
  return found.length > 0 ? "warning" : "";
}

function nodeButton(drawn: Drawn, node: GraphNode): SVGElement {
  const state = drawn.document.states.find((state) => state.name === node.state)!;
  const choice: Choice = { kind: "state", state: state.name };
  const [key, path] = [keyOf(choice), pathOf(drawn.document, choice)];
  const { box } = node;
  const start = state.name === drawn.document.start;
  return svg(
    "g",
    {
      class: () =>
        [
          "node",
          start ? "start" : "",
          drawn.live() === state.name ? "live" : "",
          flaw(drawn, path, state.name),
        ].join(" "),
      role: "button",
      tabindex: 0,
      "aria-pressed": () => String(chosen(drawn, key)),
      "aria-label": () => nodeWords(drawn, state, start, flaw(drawn, path, state.name)),
      "data-key": key,
      "data-state": state.name,
    },
    svg("rect", { ...place(box), rx: 9 }),
    ...(start ? [startMark(box)] : []),
    text(box.x + box.width / 2, box.y + 23, "name", short(state.name)),
    " ",
    text(box.x + box.width / 2, box.y + 42, "note", notes(state)),
    " ",
    svg("circle", { class: "handle", cx: box.x + box.width, cy: box.y + box.height / 2, r: 7 }),
    text(box.x + 12, box.y + 14, "flaw", () => MARKS[flaw(drawn, path, state.name)]),
  );
}

const MARKS = { refused: "✕", warning: "!", "": "" } as const;

function startMark(box: Box): SVGElement {
  const y = box.y + box.height / 2;
  return svg("path", { class: "start-mark", d: `M${box.x - 22} ${y}h14m-5 -5l6 5l-6 5` });
}

function nodeWords(drawn: Drawn, state: State, start: boolean, found: keyof typeof MARKS): string {
  const transitions = transitionsOf(state).length;
  return [
    // what is seen comes first, so that speech input finds it
    `${short(state.name)} ${notes(state)} ${MARKS[found]}`.trim(),
    `state ${state.name}`,
    start ? "the start" : "",
    transitions === 1 ? "1 transition out" : `${transitions || "no"} transitions out`,
    found,
    drawn.live() === state.name ? "the press is here" : "",
  ]
    .filter(Boolean)
    .join(", ");
}

function notes(state: State): string {
  const plays = state.enter_signal || state.repeat_signal ? " ♪" : "";
  const bias = state.bias_cN || state.bias_end_cN ? " ±" : "";
  return `key ${state.key ?? 0}${plays}${bias}`;
}

function short(name: string): string {
  const letters = [...name];
  return letters.length > LONGEST ? `${letters.slice(0, LONGEST - 1).join("")}…` : name;
}

function arrow(drawn: Drawn, edge: GraphEdge): SVGElement {
  const key = keyOf({ kind: "transition", state: edge.state, index: edge.index });
  const [before, end] = edge.points.slice(-2) as [Point, Point];
  const length = Math.hypot(end.x - before.x, end.y - before.y) || 1;
  const [dx, dy] = [(end.x - before.x) / length, (end.y - before.y) / length];
  const back = { x: end.x - dx * HEAD.length, y: end.y - dy * HEAD.length };
  const head = `M${end.x} ${end.y}L${back.x - dy * HEAD.half} ${back.y + dx * HEAD.half}L${back.x + dy * HEAD.half} ${back.y - dx * HEAD.half}Z`;
  const d = svgPath(edge.points);
  return svg(
    "g",
    {
      class: () => `arrow${chosen(drawn, key) ? " chosen" : ""}`,
      "data-key": `arrow of ${key}`,
      "data-state": edge.state,
      "data-way": edge.index,
      "aria-hidden": "true",
    },
    svg("path", { class: "broad", d }),
    svg("path", { class: "thin", d }),
    svg("path", { class: "head", d: head }),
    ...(edge.leader ? [leader(edge)] : []),
  );
}

function leader(edge: GraphEdge): SVGElement {
  const [from, to] = [centreOf(edge.label), edge.leader!];
  return svg("line", { class: "leader", x1: from.x, y1: from.y, x2: to.x, y2: to.y });
}

function edgeButton(drawn: Drawn, edge: GraphEdge): SVGElement {
  const choice: Choice = { kind: "transition", state: edge.state, index: edge.index };
  const [key, path] = [keyOf(choice), pathOf(drawn.document, choice)];
  const state = drawn.document.states.find((state) => state.name === edge.state)!;
  const transition = transitionsOf(state)[edge.index]!;
  const { label } = edge;
  const first = label.y + label.height / 2 - ((edge.lines.length - 1) * 17) / 2 + 4;
  return svg(
    "g",
    {
      class: () => `words ${flaw(drawn, path, null)}`,
      role: "button",
      tabindex: 0,
      "aria-pressed": () => String(chosen(drawn, key)),
      "aria-label": () =>
        [
          edge.lines.join(" "),
          `from ${edge.state} to ${edge.to} ${transitionInWords(transition.when, transition.only_if, state.velocity)}`,
          flaw(drawn, path, null),
        ]
          .filter(Boolean)
          .join(", "),
      "data-key": key,
      "data-state": edge.state,
      "data-way": edge.index,
    },
    svg("rect", { ...place(label), rx: 6 }),
    ...edge.lines.flatMap((line, i) => [text(label.x + label.width / 2, first + i * 17, "line", line), " "]),
  );
}

function place(box: Box): Readonly<Record<string, number>> {
  return { x: box.x, y: box.y, width: box.width, height: box.height };
}

function text(x: number, y: number, kind: string, words: string | (() => string)): SVGElement {
  const element = svg("text", { x, y, class: kind });
  if (typeof words === "string") element.textContent = words;
  else followText(element, words);
  return element;
}

function followText(element: SVGElement, words: () => string): void {
  effect(() => {
    element.textContent = words();
  });
}
