/** The numbers of the design that is looked at; one that nobody has tried yet can be edited. */

import { call } from "../../net";
import type { OptimizeDetail, OptimizeTrial } from "../../net/messages";
import {
  button,
  computed,
  h,
  numberField,
  panel,
  type Signal,
  shown,
  signal,
  tell,
  untracked,
} from "../../ui";
import { type Design, named, type RunStore } from "./store";

export function designPanel(store: RunStore): HTMLElement {
  // made anew with the trial or its state, not with every number that is typed
  const key = computed(() => {
    const trial = store.trial();
    return trial ? `${trial.number} ${trial.state} ${JSON.stringify(trial.design)}` : "";
  });
  return panel("Design", askRow(store), () => {
    if (!key()) return h("p", { class: "muted" }, "No design yet.");
    return untracked(() =>
      content(store, store.detail.peek() as OptimizeDetail, store.trial() as OptimizeTrial),
    );
  });
}

/** Ask for the next design without playing it yet, to look at it and to change it. */
function askRow(store: RunStore): HTMLElement {
  const busy = signal(false);
  const ask = async () => {
    busy.set(true);
    try {
      const { trial } = await call("optimize.next", { run: store.run });
      await store.refresh();
      store.chosen.set(trial);
    } catch (error) {
      tell(error);
    } finally {
      busy.set(false);
    }
  };
  const full = () => (store.detail()?.row.spent ?? 0) >= (store.detail()?.row.budget ?? 1);
  return h(
    "div",
    { class: "row", hidden: () => !!store.open() || full() },
    button({
      label: "Show the next design",
      act: () => void ask(),
      disabled: busy,
      hint: "Look at it, or change it, before you play it",
    }),
  );
}

function content(store: RunStore, detail: OptimizeDetail, trial: OptimizeTrial): HTMLElement {
  const editable = trial.state === "suggested";
  const draft = signal<Design>(trial.design);
  const by = trial.origin === "start" ? "the button you start from" : `suggested by ${trial.origin}`;
  return h(
    "div",
    { class: "opt-design" },
    h(
      "p",
      { class: "muted" },
      `Trial ${trial.number + 1}, ${by}${trial.edited ? ", edited by you" : ""}.`,
      editable ? " You may change it before it is played." : "",
    ),
    h(
      "div",
      { class: "opt-numbers" },
      detail.parameters.map((parameter) =>
        editable ? field(parameter, draft) : figure(parameter.name, trial.design),
      ),
    ),
    editable ? saveRow(store, trial, draft) : null,
    detail.rules.length
      ? h(
          "details",
          {},
          h("summary", {}, "Constraints of every design"),
          h(
            "ul",
            {},
            detail.rules.map((rule) => h("li", {}, rule)),
          ),
        )
      : null,
  );
}

function field(one: OptimizeDetail["parameters"][number], draft: Signal<Design>): HTMLElement {
  const { label, unit } = named(one.name);
  const set = (value: number) => draft.update((now) => ({ ...now, [one.name]: value }));
  return numberField({
    label,
    unit,
    value: () => draft()[one.name] ?? null,
    set,
    least: one.low,
    most: one.high,
    step: unit === "cN" ? 5 : 0.1,
    digits: 2,
  });
}

function figure(name: string, design: Design): HTMLElement {
  const { label, unit } = named(name);
  return h(
    "span",
    { class: "opt-figure" },
    h("span", { class: "muted" }, label),
    ` ${shown(design[name] ?? NaN, 2)} ${unit}`,
  );
}

function saveRow(store: RunStore, trial: OptimizeTrial, draft: Signal<Design>): HTMLElement {
  const changed = () => Object.entries(draft()).some(([name, value]) => trial.design[name] !== value);
  const save = async () => {
    try {
      await call("optimize.edit", { run: store.run, trial: trial.number, design: draft.peek() });
      await store.refresh();
    } catch (error) {
      tell(error);
    }
  };
  return h(
    "div",
    { class: "row" },
    button({ label: "Use this design", act: () => void save(), disabled: () => !changed() }),
    button({ label: "Undo", kind: "quiet", act: () => draft.set(trial.design), disabled: () => !changed() }),
  );
}
