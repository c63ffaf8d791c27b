/** Two designs, one after the other under the finger: which do you prefer? */

import { call } from "../../net";
import type { OptimizeAnswer, OptimizePair } from "../../net/messages";
import {
  addShortcuts,
  button,
  computed,
  effect,
  empty,
  h,
  onCleanup,
  panel,
  progress,
  type Signal,
  signal,
  tell,
  untracked,
} from "../../ui";
import { type PressStage, pressStage } from "../press/stage";
import type { RunStore } from "./store";

/** Enough for the stiffest design of the paper's space, 310 cN at any place. */
export const PUSH_cN = 350;
type Side = "A" | "B";
type Answer = OptimizeAnswer["answer"];

export function preferView(store: RunStore): HTMLElement {
  const number = computed(() => store.detail()?.pairs.find((pair) => pair.answer === null)?.number ?? null);
  const full = computed(() => (store.detail()?.row.spent ?? 0) >= (store.detail()?.row.budget ?? 1));
  effect(() => {
    // the next two are asked for as soon as the last were compared
    if (number() === null && !full())
      untracked(() => void call("optimize.pair", { run: store.run }).then(() => store.refresh(), tell));
  });
  return h(
    "div",
    { class: "opt-run-page" },
    () => {
      const now = number();
      if (now !== null)
        return untracked(() => asking(store, store.detail.peek()?.pairs[now] as OptimizePair));
      return full()
        ? empty("All comparisons are made", "See the result: the design that your answers favour.")
        : h("p", { class: "muted", role: "status" }, "The engine chooses two designs …");
    },
    made(store),
  );
}

function asking(store: RunStore, pair: OptimizePair): HTMLElement {
  const side = signal<Side>("A");
  const tried = signal<ReadonlySet<Side>>(new Set());
  const busy = signal(false);
  const host = h("div", {});
  const stage = pressStage(host, { compact: true, push_cN: PUSH_cN });
  followSide(store, pair, side, stage);
  effect(() => {
    if (stage.session.actuations())
      tried.update((all) => (all.has(side.peek()) ? all : new Set([...all, side.peek()])));
  });
  const unready = () => busy() || tried().size < 2;
  const say = async (answer: Answer) => {
    if (untracked(unready)) return;
    busy.set(true);
    try {
      await call("optimize.answer", { run: store.run, pair: pair.number, answer });
      await store.refresh();
    } catch (error) {
      tell(error);
    } finally {
      busy.set(false);
    }
  };
  addShortcuts(
    { keys: "X", does: "Swap A and B", act: () => side.update((now) => (now === "A" ? "B" : "A")) },
    { keys: "1", does: "I prefer A", act: () => void say("first") },
    { keys: "2", does: "I prefer B", act: () => void say("second") },
    { keys: "0", does: "No difference", act: () => void say("equal") },
  );
  const one = (name: Side) =>
    button({
      label: `${name} under the finger`,
      act: () => side.set(name),
      pressed: () => side() === name,
      hint: "X swaps A and B",
    });
  const reply = (label: string, answer: Answer) =>
    button({ label, kind: "main", act: () => void say(answer), disabled: unready });
  return panel(
    `Comparison ${pair.number + 1}`,
    h(
      "div",
      { class: "row", role: "group", "aria-label": "Which one is under the finger" },
      one("A"),
      one("B"),
    ),
    h(
      "div",
      { class: "row" },
      reply("I prefer A", "first"),
      reply("I prefer B", "second"),
      reply("No difference", "equal"),
      h("span", { class: "muted", role: "status" }, () =>
        tried().size < 2 ? "Press both until their key goes down, then answer." : "",
      ),
    ),
    host,
  );
}

/** Put the design of a side under the finger, whenever it changes. */
function followSide(store: RunStore, pair: OptimizePair, side: Signal<Side>, stage: PressStage): void {
  let gone = false;
  onCleanup(() => (gone = true));
  effect(() => {
    const now = side();
    const design = now === "A" ? pair.first : pair.second;
    const put = (model: Readonly<Record<string, unknown>>) => {
      if (!gone && side.peek() === now) stage.start({ what: { model }, mode: "intended", rig: "paper" });
    };
    void call("optimize.model", { run: store.run, design, name: now }).then(
      (found) => put(found.model),
      tell,
    );
  });
}

function made(store: RunStore): HTMLElement {
  const spent = () => store.detail()?.row.spent ?? 0;
  const budget = () => store.detail()?.row.budget ?? null;
  return panel(
    "Progress",
    progress("Comparisons made", spent, budget),
    h("p", { class: "muted" }, () => `${spent()} of ${budget() ?? "…"} comparisons`),
  );
}
