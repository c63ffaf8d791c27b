/** What a comparison comes to: how different the buttons feel, in just noticeable differences. */

import { address } from "../../app/route";
import type { Step, Verdict } from "../../app/verdict";
import { call, StudioError } from "../../net";
import type { LibraryButton } from "../../net/messages";
import { effect, force, type Signal, signal, unitText, untracked } from "../../ui";
import { figure } from "./columns";
import { MOST_SHARED, share } from "./export";
import { asked, EVERYTHING } from "./state";
import type { LibraryStore } from "./store";

/** What buttons differ by, with unit and decimals; the one that differs most is named. */
const FIGURES = [
  ["drop_cN", "bump", "cN", 1],
  ["peak_cN", "peak", "cN", 1],
  ["actuation_mm", "actuation", "mm", 2],
  ["bottom_out_cN", "bottom-out", "cN", 1],
  ["travel_mm", "travel", "mm", 2],
] as const;

/** How far buttons are from the reference, by id, and whose just noticeable differences that counts. */
export interface Distances {
  readonly jnd: ReadonlyMap<string, number>;
  readonly whose: string;
  /** Why no distance could be computed; empty if none is wrong. */
  readonly fault: string;
}

/** Return what the comparison comes to, and the next step. */
export function conclusion(store: LibraryStore): () => Verdict | null {
  const away = distances(store);
  return () => {
    const { overlay, reference } = store.shown();
    const first = store.buttons().get(reference ?? "");
    if (!first) return null;
    const others = overlay.flatMap((id) => (id === reference ? [] : (store.buttons().get(id) ?? [])));
    if (!others.length) return { sentence: about(first), next: editing(first) };
    const next = overlay.length <= MOST_SHARED ? sharing(store) : editing(first);
    return { ...compared(first, others, away()), next };
  };
}

/** What buttons come to beside the first; without a distance, why there is none. */
export function compared(first: LibraryButton, others: readonly LibraryButton[], away: Distances): Verdict {
  const [second, ...more] = others as [LibraryButton];
  const sentence = more.length ? many(first, others, away) : two(first, second, away);
  return away.fault ? { sentence: `${sentence} No distance: ${away.fault}.`, kind: "warning" } : { sentence };
}

function editing({ id, name }: LibraryButton): Step {
  return { label: `Edit ${name}`, to: address("edit", id) };
}

function sharing(store: LibraryStore): Step {
  return { label: "Share this comparison", act: () => share(store.shown.peek()) };
}

/** What one button is like. */
export function about({ name, kind, numbers }: LibraryButton): string {
  const { peak_cN, drop_cN, bottom_out_cN, travel_mm } = numbers;
  const bump = peak_cN && drop_cN ? `a bump of ${force(drop_cN)} under its peak of ${force(peak_cN)}, ` : "";
  return `${name} is ${kind.replace("?", "")}: ${bump}${figure(bottom_out_cN, 1, "cN")} ${unitText("cN")} at the end of ${figure(travel_mm, 2)} mm.`;
}

/** How two buttons differ: the figure that differs most, and whether a finger notices. */
export function two(first: LibraryButton, second: LibraryButton, away: Distances): string {
  const off = ([name]: (typeof FIGURES)[number]) => {
    const [a, b] = [first.numbers[name] ?? 0, second.numbers[name] ?? 0];
    return a && b ? Math.abs(Math.log(a / b)) : -1;
  };
  const [name, word, unit, digits] = [...FIGURES].sort((a, b) => off(b) - off(a))[0]!;
  const values = [first, second].map((one) => figure(one.numbers[name], digits, unit));
  const jnd = away.jnd.get(second.id);
  const felt = jnd === undefined ? "" : `; ${jndText(jnd)} apart: ${notices(jnd)}, by ${away.whose}`;
  return `${first.name} against ${second.name}: ${word} ${values.join(" against ")} ${unitText(unit)}${felt}.`;
}

export function many(
  first: LibraryButton,
  others: readonly LibraryButton[],
  { jnd: away, whose }: Distances,
): string {
  const known = others.filter(({ id }) => away.has(id)).sort((a, b) => away.get(a.id)! - away.get(b.id)!);
  const [near, far] = [known[0], known.at(-1)];
  if (!near || !far || near === far) return `${others.length + 1} buttons compared with ${first.name}.`;
  const said = (one: LibraryButton) => `${one.name} (${jndText(away.get(one.id)!)})`;
  return `${said(near)} feels nearest to ${first.name}, ${said(far)} least like it, by ${whose}.`;
}

function jndText(jnd: number): string {
  return `${jnd.toFixed(1)} JND`;
}

function notices(jnd: number): string {
  return jnd < 1 ? "computed to feel alike" : "computed to feel different";
}

/** How far every button is from the reference, JND; asked again when another becomes the reference. */
function distances(store: LibraryStore): Signal<Distances> {
  const none: Distances = { jnd: new Map(), whose: "", fault: "" };
  const found: Signal<Distances> = signal(none);
  effect(() => {
    const { reference, overlay } = store.shown();
    store.grown();
    if (!reference || overlay.length < 2) return;
    const stop = new AbortController();
    untracked(() => found.set(none));
    call("library.find", asked({ ...EVERYTHING, like: reference }), stop.signal).then(
      ({ epoch, positions, distances_jnd, jnds }) => {
        if (epoch !== store.rows.epoch) return;
        const pairs = positions.map((at, i) => [store.rows.ids[at] ?? "", distances_jnd[i] ?? NaN] as const);
        found.set({ jnd: new Map(pairs.filter(([, jnd]) => Number.isFinite(jnd))), whose: jnds, fault: "" });
      },
      (error: unknown) => {
        // while the index grows, the reference may not be in it yet
        if (error instanceof StudioError && store.rows.at(reference) >= 0)
          found.set({ ...none, fault: error.message });
      },
    );
    return () => stop.abort();
  });
  return found;
}
