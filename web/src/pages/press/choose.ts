/** What is pressed: buttons and programs, how they are brought to the finger, two of them to compare. */

import type { PressItem, PressList } from "../../net/messages";
import { button, choice, computed, h, type Signal, signal } from "../../ui";
import type { Choice, Mode, What } from "./session";

const MODES: readonly (readonly [Mode, string])[] = [
  ["intended", "as designed"],
  ["compensated", "on a rig, compensated"],
  ["rendered", "on a rig, not compensated"],
];

/** One of the two things that are compared. */
export interface Pick {
  /** "button builtin:mx-clear" or "program shipped:multi-level". */
  readonly item: string;
  readonly mode: Mode;
  readonly rig: string;
}

export type Side = "A" | "B";

export class Chooser {
  readonly side: Signal<Side> = signal<Side>("A");
  readonly picks: Readonly<Record<Side, Signal<Pick>>>;
  readonly element: HTMLElement;

  constructor(
    private readonly list: PressList,
    first: Pick,
    second: Pick,
  ) {
    this.picks = { A: signal(first), B: signal(second) };
    this.element = h(
      "div",
      { class: "press-choose" },
      h(
        "div",
        { class: "row", role: "group", "aria-label": "Compare two" },
        this.sideButton("A"),
        this.sideButton("B"),
      ),
      choice({
        label: "Press",
        options: this.options(),
        value: () => this.now().item,
        set: (item) => this.change({ item }),
      }),
      choice({
        label: "how",
        options: MODES,
        value: () => this.now().mode,
        set: (mode) => this.change({ mode }),
      }),
      () =>
        this.now().mode === "intended"
          ? null
          : choice({
              label: "rig",
              options: list.rigs.map((rig) => [rig, rig] as const),
              value: () => this.now().rig,
              set: (rig) => this.change({ rig }),
            }),
      h(
        "p",
        { class: "press-hint" },
        computed(() => this.hint()),
      ),
    );
  }

  /** What is chosen on the side of now; follows signals. */
  now(): Pick {
    return this.picks[this.side()]();
  }

  swap(): void {
    this.side.update((side) => (side === "A" ? "B" : "A"));
  }

  choiceNow(): Choice {
    const { item, mode, rig } = this.now();
    return { what: whatOf(item), mode, rig };
  }

  private sideButton(side: Side): HTMLElement {
    const name = () => this.nameOf(this.picks[side]().item);
    const made = button({
      label: side,
      act: () => this.side.set(side),
      hint: "X swaps A and B, also while pressing",
      pressed: () => this.side() === side,
    });
    made.append(h("span", {}, () => ` ${name()}`));
    return made;
  }

  private change(by: Partial<Pick>): void {
    this.picks[this.side.peek()].update((pick) => ({ ...pick, ...by }));
  }

  private options(): (readonly [string, string])[] {
    const named = (kind: string, group: string) => (item: PressItem) =>
      [`${kind} ${item.id}`, `${group}: ${item.name}`] as const;
    const listed = [
      ...this.list.buttons.map(named("button", "Button")),
      ...this.list.programs.map(named("program", "Program")),
    ];
    // a measured button that the address names is on no list
    const { item } = this.picks.A.peek();
    return this.found(item) ? listed : [[item, this.nameOf(item)], ...listed];
  }

  private found(item: string): PressItem | undefined {
    const [kind, id] = item.split(/ (.*)/s, 2);
    return (kind === "program" ? this.list.programs : this.list.buttons).find((one) => one.id === id);
  }

  private nameOf(item: string): string {
    return this.found(item)?.name ?? item.split(":").slice(1).join(":");
  }

  private hint(): string {
    const { item } = this.now();
    return item.startsWith("program ") ? (this.found(item)?.hint ?? "") : "";
  }
}

/** Read what a pick names. */
export function whatOf(item: string): What {
  const [kind, id] = item.split(/ (.*)/s, 2);
  return kind === "program" ? { program: id ?? "" } : { button: id ?? "" };
}
