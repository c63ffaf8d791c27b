import {
  type Condition,
  type ConditionKind,
  type ProgramDocument,
  transitionsOf,
  type VelocitySource,
} from "./document";

/** What is known of a kind of condition. */
export interface KindOfCondition {
  readonly kind: ConditionKind;
  /** In a list to choose from. */
  readonly label: string;
  /** Of its value; empty for one without. */
  readonly unit: string;
  readonly low: number;
  readonly high: number;
  readonly whole: boolean;
  /** A value to begin with; `true` for a kind that takes none. */
  readonly first: number | true;
}

function kind(
  name: ConditionKind,
  label: string,
  unit: string,
  [low, high]: readonly [number, number],
  first: number | true,
  whole = false,
): KindOfCondition {
  return { kind: name, label, unit, low, high, whole, first };
}

/** Every kind, in the order in which people look for them; bounds as fdvv.program checks them. */
export const KINDS: readonly KindOfCondition[] = [
  kind("deeper_than_mm", "deeper than", "mm", [-100, 100], 1),
  kind("shallower_than_mm", "shallower than", "mm", [-100, 100], 0.5),
  kind("turned_to_press", "turns to the press", "", [0, 0], true),
  kind("turned_to_release", "turns to the release", "", [0, 0], true),
  kind("faster_than_mm_s", "faster than", "mm/s", [0, 4000], 100),
  kind("slower_than_mm_s", "slower than", "mm/s", [0, 4000], 20),
  kind("after_ms", "after a time of", "ms", [0, 2 ** 31 - 1], 500, true),
  kind("fallen_by_mm", "fallen by", "mm", [0, 100], 0.2),
  kind("risen_by_mm", "risen by", "mm", [0, 100], 0.2),
  kind("host_event", "host event number", "", [0, 31], 0, true),
  kind("always", "at once", "", [0, 0], true),
];

const BY_NAME = new Map(KINDS.map((known) => [known.kind, known]));

/** Return what is known of the kind of a condition. */
export function kindOf(condition: Condition): KindOfCondition {
  const name = Object.keys(condition)[0] as ConditionKind | undefined;
  const known = name === undefined ? undefined : BY_NAME.get(name);
  if (!known) throw new RangeError(`no condition ${name ?? "at all"}`);
  return known;
}

/** Return the value of a condition, `null` for one that takes none. */
export function conditionValue(condition: Condition): number | null {
  const value = condition[kindOf(condition).kind];
  return typeof value === "number" ? value : null;
}

/** Make a condition; without a value the kind's first one. */
export function condition(name: ConditionKind, value?: number): Condition {
  const known = BY_NAME.get(name);
  if (!known) throw new RangeError(`no condition ${name}`);
  return { [name]: known.first === true ? true : (value ?? known.first) };
}

/** What is wrong with the value of a condition, or nothing. */
export function valueProblem(condition: Condition): string | null {
  const known = kindOf(condition);
  const value = conditionValue(condition);
  if (value === null) return null;
  if (!Number.isFinite(value)) return "enter a number";
  if (value < known.low || value > known.high)
    return `${plain(known.low)} to ${plain(known.high)} ${known.unit}`.trim();
  return known.whole && !Number.isInteger(value) ? "a whole number" : null;
}

/** Write a number as people do: at most four digits behind the point, none that say nothing. */
export function plain(value: number): string {
  return String(Number(value.toFixed(4))).replace("-", "−");
}

const SHORT: Readonly<Record<ConditionKind, (value: string) => string>> = {
  always: () => "at once",
  deeper_than_mm: (x) => `x > ${x} mm`,
  shallower_than_mm: (x) => `x < ${x} mm`,
  turned_to_press: () => "turns ↓",
  turned_to_release: () => "turns ↑",
  faster_than_mm_s: (v) => `v > ${v} mm/s`,
  slower_than_mm_s: (v) => `v < ${v} mm/s`,
  after_ms: (t) => `after ${t} ms`,
  host_event: (n) => `event ${n}`,
  risen_by_mm: (x) => `risen ${x} mm`,
  fallen_by_mm: (x) => `fallen ${x} mm`,
};

/** Write a condition as short as it fits on an arrow. */
export function shortly(condition: Condition): string {
  return SHORT[kindOf(condition).kind](plain(conditionValue(condition) ?? 0));
}

const SPEEDS: Readonly<Record<VelocitySource, string>> = {
  announced: "the announced speed",
  decided: "the speed measured in this press",
  continuous: "the speed at that instant",
};

/** Write a condition in words, as in "the cap is deeper than 1.2 mm". */
export function inWords(condition: Condition, velocity: VelocitySource = "decided"): string {
  const value = plain(conditionValue(condition) ?? 0);
  switch (kindOf(condition).kind) {
    case "always":
      return "at the next tick";
    case "deeper_than_mm":
      return `the cap is deeper than ${value} mm`;
    case "shallower_than_mm":
      return `the cap is above ${value} mm`;
    case "turned_to_press":
      return "the cap turns to go down";
    case "turned_to_release":
      return "the cap turns to come up";
    case "faster_than_mm_s":
      return `${SPEEDS[velocity]} is above ${value} mm/s`;
    case "slower_than_mm_s":
      return `${SPEEDS[velocity]} is below ${value} mm/s`;
    case "after_ms":
      return `${value} ms have passed in the state`;
    case "host_event":
      return `the host has sent event ${value}`;
    case "risen_by_mm":
      return `the cap has risen by ${value} mm from the deepest point in the state`;
    case "fallen_by_mm":
      return `the cap has fallen by ${value} mm from the highest point in the state`;
  }
}

/** Write when a transition is taken. */
export function transitionInWords(
  when: Condition,
  onlyIf: Condition | null | undefined,
  velocity: VelocitySource = "decided",
): string {
  const first = `when ${inWords(when, velocity)}`.replace("when at the", "at the");
  return onlyIf ? `${first}, but only while ${inWords(onlyIf, velocity)}` : first;
}

/** Return the displacement that a condition names, or null. */
export function positionOf_mm(condition: Condition): number | null {
  const name = kindOf(condition).kind;
  return name === "deeper_than_mm" || name === "shallower_than_mm" ? conditionValue(condition) : null;
}

/** A new arrow leads on beyond half the travel, or back above a quarter of it: far enough apart not to flutter. */
export function firstCondition(document: ProgramDocument, from: string): Condition {
  const part_mm = (ratio: number): number => Math.round(document.travel_mm * ratio * 100) / 100;
  return from === document.start
    ? condition("deeper_than_mm", part_mm(0.5))
    : condition("shallower_than_mm", part_mm(0.25));
}

/** Return the host events that a program waits for, rising. */
export function eventsOf(document: ProgramDocument): readonly number[] {
  const numbers = document.states
    .flatMap(transitionsOf)
    .flatMap(({ when, only_if }) => (only_if ? [when, only_if] : [when]))
    .filter((held) => kindOf(held).kind === "host_event")
    .map((held) => conditionValue(held) ?? 0);
  return [...new Set(numbers)].sort((a, b) => a - b);
}
