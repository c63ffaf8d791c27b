/** A program as its file holds it, `*.fdvv-program.json`; see docs/reference/program-file.md. */

/** What a condition looks at; the unit of its value ends the name. */
export type ConditionKind =
  | "always"
  | "deeper_than_mm"
  | "shallower_than_mm"
  | "turned_to_press"
  | "turned_to_release"
  | "faster_than_mm_s"
  | "slower_than_mm_s"
  | "after_ms"
  | "host_event"
  | "risen_by_mm"
  | "fallen_by_mm";

/** One field: the kind of the condition with its value, `true` where it takes none. */
export type Condition = Readonly<Partial<Record<ConditionKind, number | true>>>;

export type Stroke = "press" | "release";
export type During = Stroke | "either";
export type VelocitySource = "announced" | "decided" | "continuous";

/** The way to another state, taken when `when` and `only_if` both hold. */
export interface Transition {
  readonly to: string;
  readonly when: Condition;
  readonly only_if?: Condition | null;
  readonly signal?: string | null;
}

/** What is felt and reported until a transition leads on. */
export interface State {
  readonly name: string;
  readonly press: string;
  readonly release: string;
  readonly key?: number;
  readonly velocity?: VelocitySource;
  readonly enter_signal?: string | null;
  readonly repeat_signal?: string | null;
  readonly repeat_ms?: number;
  readonly fade_ms?: number;
  readonly bias_cN?: number;
  readonly bias_end_cN?: number;
  readonly bias_ms?: number;
  readonly transitions?: readonly Transition[];
}

/** Force on displacement, a row per velocity; bilinear between its points, its edges held outside. */
export interface Surface {
  readonly name: string;
  readonly displacement_mm: readonly number[];
  readonly velocity_mm_s: readonly number[];
  readonly force_cN: readonly (readonly number[])[];
}

/** One decaying sinusoid of the cap's acceleration. */
export interface Mode {
  readonly frequency_Hz: number;
  readonly amplitude_m_s2: number;
  readonly decay_1_s: number;
  readonly phase_rad?: number;
}

/** A short vibration of the cap, without a place. */
export interface Signal {
  readonly name: string;
  readonly duration_s: number;
  readonly modes: readonly Mode[];
}

/** A signal felt at a displacement, once per stroke. */
export interface VibrationEvent {
  readonly signal: string;
  readonly at_mm: number;
  readonly stroke?: During;
  readonly slowest_mm_s?: number | null;
  readonly fastest_mm_s?: number | null;
  readonly states?: readonly string[];
}

/** A button as a machine of states. */
export interface ProgramDocument {
  readonly format: "fdvv-program";
  readonly version: 1;
  readonly name: string;
  readonly travel_mm: number;
  readonly start: string;
  readonly states: readonly State[];
  readonly surfaces: readonly Surface[];
  readonly signals?: readonly Signal[];
  readonly vibrations?: readonly VibrationEvent[];
  readonly description?: string;
}

/** What a device holds at most, as protocol/fdvv.toml tells; the server's check has the last word. */
export const MOST = {
  states: 16,
  transitions: 48,
  surfaces: 16,
  vibrations: 32,
  signals: 16,
  velocities: 16,
} as const;

/** Bounds of the fields of a document that are plain numbers: least, most. */
export const BOUNDS = {
  travel_mm: [0.2, 6.4],
  key: [0, 255],
  repeat_ms: [0, 65_535],
  fade_ms: [0, 2000],
  bias_ms: [0, 65_535],
  at_mm: [-2, 6.4],
  velocity_mm_s: [0, 4000],
} as const satisfies Record<string, readonly [number, number]>;

/** Return the transitions of a state; a file leaves out an empty list. */
export function transitionsOf(state: State): readonly Transition[] {
  return state.transitions ?? [];
}

/** Return which state has a name, or undefined. */
export function stateNamed(document: ProgramDocument, name: string): State | undefined {
  return document.states.find((state) => state.name === name);
}

/** Return which surface has a name, or undefined. */
export function surfaceNamed(document: ProgramDocument, name: string): Surface | undefined {
  return document.surfaces.find((surface) => surface.name === name);
}

/** Read the text of a program that the server has checked: it is JSON of this shape. */
export function readDocument(text: string): ProgramDocument {
  return JSON.parse(text) as ProgramDocument;
}

/** Write a program as text; the server turns it into the canonical one. */
export function writeDocument(document: ProgramDocument): string {
  return JSON.stringify(document);
}

/** Return the first name of the row `stem`, `stem 2`, `stem 3`, … that is not taken, within 40 characters. */
export function freeName(stem: string, taken: Iterable<string>): string {
  const used = new Set(taken);
  const base = stem.replace(/ \d+$/, "").slice(0, 36).trim() || "new";
  for (let number = 1; ; number += 1) {
    const name = number === 1 ? base : `${base} ${number}`;
    if (!used.has(name)) return name;
  }
}

/** What is wrong with a name of a part, or nothing: the rule of the file, and that names differ. */
export function nameProblem(name: string, others: Iterable<string>): string | null {
  if (name.trim() === "") return "enter a name";
  if (name !== name.trim()) return "no leading or trailing spaces";
  if ([...name].length > 40) return "at most 40 characters";
  if (/\p{C}/u.test(name)) return "printable characters only";
  return new Set(others).has(name) ? `there is already one called “${name}”` : null;
}
