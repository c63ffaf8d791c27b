/** A simulated person who plays: newGame, followed, stopped; it goes on while the page is away. */

import { call } from "../../net";
import { button, h, numberField, panel, progress, signal, tell } from "../../ui";
import type { RunStore } from "./store";

export function simulatedPanel(store: RunStore): HTMLElement {
  const person = signal(0);
  const now = () => store.detail()?.simulated ?? null;
  const running = () => now()?.running ?? false;
  const left = () => Math.max(1, (store.detail()?.row.budget ?? 1) - (store.detail()?.row.spent ?? 0));
  const spent = () => (store.detail()?.row.spent ?? 0) >= (store.detail()?.row.budget ?? 1);
  const ask = (work: Promise<unknown>) => void work.then(() => store.refresh(), tell);
  const start = () =>
    ask(call("optimize.simulate", { run: store.run, person: person.peek(), trials: left() }));
  return panel(
    "A simulated person plays",
    h(
      "p",
      {},
      "A random simulated person, with finger and timing from the literature, presses the simulated button. The result says nothing about real people. ",
      h("span", { class: "tag simulated" }, "simulated"),
    ),
    h(
      "div",
      { class: "row" },
      numberField({
        label: "Person",
        unit: "",
        value: person,
        set: person.set,
        least: 0,
        most: 2 ** 31,
        digits: 0,
        disabled: running,
      }),
      button({ label: "Let them play", kind: "main", act: start, disabled: () => running() || spent() }),
      button({
        label: "Stop",
        act: () => ask(call("optimize.halt", { run: store.run })),
        disabled: () => !running(),
      }),
    ),
    h(
      "div",
      { hidden: () => !running() },
      progress(
        "Trials played",
        () => now()?.done ?? 0,
        () => now()?.total ?? null,
      ),
    ),
    h("p", { role: "status" }, () => line(now())),
  );
}

function line(
  now: {
    readonly running: boolean;
    readonly done: number;
    readonly total: number;
    readonly told: string;
    readonly fault: string;
  } | null,
): string {
  if (!now) return "";
  if (now.fault) return `${now.told} stopped: ${now.fault}`;
  return `${now.told}: ${now.done} of ${now.total} trials${now.running ? " …" : ", done"}`;
}
