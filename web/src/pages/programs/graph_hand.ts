/** What hands and keys do to the graph of a program: choose, drag and draw its nodes and arrows. */

import { firstCondition } from "../../programs/condition";
import { type ProgramDocument, stateNamed, transitionsOf } from "../../programs/document";
import { addState, addTransition, removeState, removeTransition } from "../../programs/edits";
import { centreOf, contains, type Point } from "../../programs/geometry";
import { type Graph, graphOf, neighbour, withMoved } from "../../programs/graph_layout";
import type { Choice } from "../../programs/path";
import { computed, effect, type Signal, signal } from "../../ui";
import type { ProgramBook } from "./book";
import { keyOf } from "./graph_parts";
import { GraphView } from "./graph_view";
import { savedPositions, savePositions } from "./positions";

const DRAG_px = 4;
const STEP_px = 20;
const ARROWS: Readonly<Record<string, Point>> = {
  ArrowLeft: { x: -1, y: 0 },
  ArrowRight: { x: 1, y: 0 },
  ArrowUp: { x: 0, y: -1 },
  ArrowDown: { x: 0, y: 1 },
};

/** What the hand does: a press may become a drag of a node, a new arrow, or a move of the view. */
type Hand =
  | {
      readonly kind: "node";
      readonly state: string;
      readonly from: Point;
      readonly grab: Point;
      dragging: boolean;
    }
  | { readonly kind: "arrow"; readonly state: string }
  | { readonly kind: "view"; readonly client: Point; readonly origin: Point };

/** The graph with its keys: see the list that is shown with "?". */
export class GraphHand {
  /** The state from which an arrow is being drawn, by hand or by keys. */
  readonly drawing: Signal<string | null> = signal<string | null>(null);
  /** Where the pointer is meanwhile. */
  readonly pointer: Signal<Point | null> = signal<Point | null>(null);
  /** Centres of nodes that a person has put somewhere. */
  readonly moved: Signal<ReadonlyMap<string, Point>>;
  readonly graph: () => Graph;
  readonly view: GraphView;
  private root!: SVGSVGElement;
  private hand: Hand | null = null;

  constructor(private readonly book: ProgramBook) {
    this.moved = savedPositions(book.id);
    effect(() => savePositions(book.id, this.moved()));
    const laidOut = computed(() => graphOf(book.document()));
    this.graph = computed(() => withMoved(laidOut(), this.moved()));
    this.view = new GraphView(this.graph);
  }

  /** Work the graph that is drawn in an element, until the scope of the call ends. */
  follow(root: SVGSVGElement): void {
    this.root = root;
    this.view.follow(root);
    root.addEventListener("pointerdown", (event) => this.down(event));
    root.addEventListener("pointermove", (event) => this.dragged(event));
    root.addEventListener("pointerup", (event) => this.up(event));
    root.addEventListener("pointercancel", () => this.drop());
    root.addEventListener("keydown", (event) => this.key(event));
    root.addEventListener("dblclick", (event) => {
      // the pointer is captured, so the event's own target is the whole graph
      const under = document.elementFromPoint(event.clientX, event.clientY);
      if (!under?.closest("[data-key]")) this.addState(this.view.at(event));
    });
  }

  /** Reset every state to its automatic position. */
  tidy(): void {
    this.moved.set(new Map());
    this.view.fit();
  }

  /** Put the keyboard on what is chosen. */
  focusChosen(): void {
    this.focus(keyOf(this.book.choice.peek()));
  }

  /** Add a state beside the chosen one, and choose it. */
  addState(at: Point | null = null): string {
    const [, name] = addState(this.book.document.peek());
    if (at) this.move(name, at);
    this.book.make(`add ${name}`, (held) => addState(held)[0], { kind: "state", state: name });
    return name;
  }

  /** Add an arrow between two states, and choose it. */
  connect(from: string, to: string): void {
    this.book.edit(`add ${from} → ${to}`, (held) =>
      addTransition(held, from, to, firstCondition(held, from)),
    );
    const state = stateNamed(this.book.document.peek(), from);
    if (state) this.book.choose({ kind: "transition", state: from, index: transitionsOf(state).length - 1 });
    this.drop();
  }

  /** Begin to draw an arrow by keys: the next state that is chosen with Enter is where it leads. */
  begin(): void {
    const choice = this.book.choice.peek();
    if (choice.kind === "state") this.drawing.set(choice.state);
  }

  /** Remove what is chosen. */
  remove(): void {
    const { book } = this;
    const choice = book.choice.peek();
    if (choice.kind === "state")
      book.edit(`remove ${choice.state}`, (held) => removeState(held, choice.state));
    if (choice.kind !== "transition") return;
    const without = (held: ProgramDocument) => removeTransition(held, choice.state, choice.index);
    book.make("remove a transition", without, { kind: "state", state: choice.state });
    this.focusChosen();
  }

  private focus(key: string): void {
    [...this.root.querySelectorAll<SVGElement>("[data-key]")]
      .find((held) => held.dataset.key === key)
      ?.focus();
  }

  private move(state: string, to: Point): void {
    this.moved.update((held) => new Map(held).set(state, { x: Math.round(to.x), y: Math.round(to.y) }));
  }

  private stateAt(at: Point): string | null {
    return this.graph().nodes.find((node) => contains(node.box, at))?.state ?? null;
  }

  private down(event: PointerEvent): void {
    if (event.button > 1) return;
    if (this.view.pinching) return this.drop();
    const at = this.view.at(event);
    const target = (event.target as Element).closest<SVGElement>("[data-key]");
    const state = target?.dataset.state;
    const node = state === undefined ? undefined : this.graph().nodes.find((node) => node.state === state);
    this.root.setPointerCapture(event.pointerId);
    if (target && target.dataset.way !== undefined) return this.choose(event, target);
    if (!node || !target) {
      this.hand = { kind: "view", client: { x: event.clientX, y: event.clientY }, origin: this.view.origin };
      return;
    }
    if (this.drawing.peek() && !this.hand) return this.connect(this.drawing.peek()!, node.state);
    this.choose(event, target);
    if ((event.target as Element).closest(".handle")) {
      this.hand = { kind: "arrow", state: node.state };
      this.drawing.set(node.state);
    } else {
      const centre = centreOf(node.box);
      const grab = { x: at.x - centre.x, y: at.y - centre.y };
      this.hand = { kind: "node", state: node.state, from: at, grab, dragging: false };
    }
  }

  private choose(event: Event, target: SVGElement): void {
    event.preventDefault();
    const [state, transition] = [target.dataset.state ?? "", target.dataset.way];
    this.book.choose(
      transition === undefined
        ? { kind: "state", state }
        : { kind: "transition", state, index: Number(transition) },
    );
    this.focusChosen();
  }

  private dragged(event: PointerEvent): void {
    const at = this.view.at(event);
    if (this.drawing.peek()) this.pointer.set(at);
    const hand = this.hand;
    if (hand?.kind === "view")
      this.view.moveFrom(hand.origin, event.clientX - hand.client.x, event.clientY - hand.client.y);
    if (hand?.kind !== "node") return;
    if (!hand.dragging && Math.hypot(at.x - hand.from.x, at.y - hand.from.y) > DRAG_px / this.view.zoom) {
      this.view.hold();
      hand.dragging = true;
    }
    if (hand.dragging) this.move(hand.state, { x: at.x - hand.grab.x, y: at.y - hand.grab.y });
  }

  private up(event: PointerEvent): void {
    const hand = this.hand;
    this.hand = null;
    if (hand?.kind !== "arrow") return;
    const at = this.view.at(event);
    const to = this.stateAt(at);
    const node = this.graph().nodes.find((node) => node.state === hand.state);
    // let go on the handle itself: the arrow's end is chosen by the next press
    if (to === hand.state && node && at.x > node.box.x + node.box.width - 16) return;
    if (!to && node && contains(node.box, at, 20)) return;
    this.connect(hand.state, to ?? this.addState(at));
  }

  private drop(): void {
    this.hand = null;
    this.drawing.set(null);
    this.pointer.set(null);
  }

  private key(event: KeyboardEvent): void {
    const target = (event.target as Element).closest<SVGElement>("[data-key]");
    const state = target?.dataset.state;
    if (!target || state === undefined || event.ctrlKey || event.metaKey || event.altKey) return;
    const arrow = ARROWS[event.key];
    if (arrow) this.step(state, arrow, event.shiftKey);
    else if (event.key === "Enter" || event.key === " ") this.enter(event, target, state);
    else if (event.key === "Delete" || event.key === "Backspace") this.remove();
    else if (event.key === "t" || event.key === "T") this.begin();
    else if (event.key === "n" || event.key === "N") this.addState();
    else if (event.key === "Escape" && this.drawing.peek()) this.drop();
    else return;
    event.preventDefault();
  }

  private enter(event: KeyboardEvent, target: SVGElement, state: string): void {
    const from = this.drawing.peek();
    if (from && target.dataset.way === undefined) {
      this.connect(from, state);
      this.focusChosen();
    } else this.choose(event, target);
  }

  private step(state: string, arrow: Point, moving: boolean): void {
    const node = this.graph().nodes.find((node) => node.state === state);
    if (moving && node) {
      const at = centreOf(node.box);
      return this.move(state, { x: at.x + arrow.x * STEP_px, y: at.y + arrow.y * STEP_px });
    }
    const next = neighbour(this.graph(), state, arrow.x, arrow.y);
    if (!next) return;
    const choice: Choice = { kind: "state", state: next };
    if (!this.drawing.peek()) this.book.choose(choice);
    this.focus(keyOf(choice));
  }
}
