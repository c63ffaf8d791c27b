/** The form that begins a run. */

import { go } from "../../app/route";
import { call } from "../../net";
import type { Offer, OptimizeCreate, OptimizeOffers } from "../../net/messages";
import { button, choice, h, numberField, onCleanup, type Signal, signal, tell, toggle } from "../../ui";

type Kind = "play" | "prefer" | "simulated";
const KINDS: readonly (readonly [Kind, string])[] = [
  ["play", "I play and my timing is scored"],
  ["prefer", "I compare two at a time"],
  ["simulated", "A simulated person plays"],
];
const BUDGET = { play: 27, prefer: 10, simulated: 27 } as const;

class Form {
  readonly kind = signal<Kind>("play");
  readonly title = signal("");
  readonly engine = signal("gp");
  readonly pairEngine = signal("");
  readonly space = signal("paper");
  readonly level = signal<"easy" | "hard">("easy");
  readonly start = signal("builtin:mx-clear");
  readonly rig = signal("");
  readonly others = signal("");
  readonly seed = signal(0);
  readonly budget = signal<number>(BUDGET.play);
  readonly presses = signal(20);
  readonly also: Signal<readonly string[]> = signal<readonly string[]>([]);

  /** Whether it matters what the run starts from: a comparison in the paper's space begins anywhere. */
  varies(): boolean {
    return this.kind() !== "prefer" || this.space() !== "paper";
  }

  /** Whether scores of others say anything of its designs: they scored those of the paper's space. */
  listens(): boolean {
    return this.kind() !== "prefer" && this.space() === "paper";
  }

  ask(): OptimizeCreate {
    const prefer = this.kind() === "prefer";
    return {
      title: this.title() || (prefer ? "what I prefer" : `${this.level()}, ${this.engine()}`),
      engine: prefer ? this.pairEngine() : this.engine(),
      space: this.space(),
      preference: prefer,
      simulated: this.kind() === "simulated",
      level: this.level(),
      also: this.also(),
      start: (this.varies() && this.start()) || null,
      rig: this.rig() || null,
      seed: this.seed(),
      budget: this.budget(),
      task_presses: this.presses(),
      others: (this.listens() && this.others()) || null,
    };
  }
}

export function newRun(): HTMLElement {
  const form = new Form();
  const offers = signal<OptimizeOffers | null>(null);
  const busy = signal(false);
  let gone = false;
  onCleanup(() => (gone = true));
  call("optimize.offers", {}).then((found) => {
    if (gone) return;
    form.pairEngine.set(found.pair_engines[0]?.name ?? "");
    offers.set(found);
  }, tell);
  const begin = async () => {
    busy.set(true);
    try {
      go("optimize", String((await call("optimize.create", form.ask())).run));
    } catch (error) {
      tell(error);
    } finally {
      busy.set(false);
    }
  };
  return h(
    "section",
    { class: "panel opt-new", "aria-label": "New run" },
    h("h2", {}, "New run"),
    h(
      "p",
      { class: "muted" },
      "A bullet flies along a strip; the key should go down as it reaches the zone. Twenty presses score a design, then the engine suggests the next one.",
    ),
    () => fields(form, offers()),
    h(
      "div",
      { class: "row" },
      button({ label: "Begin", kind: "main", act: () => void begin(), disabled: () => busy() || !offers() }),
    ),
  );
}

function fields(form: Form, offers: OptimizeOffers | null): HTMLElement {
  if (!offers) return h("p", { class: "muted" }, "…");
  const kinds = KINDS.filter(([kind]) => kind !== "prefer" || offers.pair_engines.length);
  const set = (kind: Kind) => {
    form.kind.set(kind);
    form.budget.set(BUDGET[kind]);
  };
  const scored = () => form.kind() !== "prefer";
  return h(
    "div",
    { class: "opt-fields" },
    choice({ label: "How", options: kinds, value: form.kind, set }),
    choice({ label: "Designs", options: options(offers.spaces), value: form.space, set: form.space.set }),
    () =>
      scored()
        ? choice({
            label: "Engine",
            options: options(offers.engines),
            value: form.engine,
            set: form.engine.set,
          })
        : choice({
            label: "Engine",
            options: options(offers.pair_engines),
            value: form.pairEngine,
            set: form.pairEngine.set,
          }),
    () => (form.varies() ? startChoice(form, offers) : null),
    choice({
      label: "Rig",
      options: [
        ["", "any: rendered as designed"],
        ...offers.rigs.map((rig) => [rig.name, `must be rendered by ${rig.told}`] as const),
      ],
      value: form.rig,
      set: form.rig.set,
    }),
    () => (scored() ? scoredFields(form, offers) : null),
    () => (form.listens() ? othersChoice(form, offers) : null),
    numberField({
      label: "Budget",
      unit: "at most",
      value: form.budget,
      set: form.budget.set,
      least: 1,
      most: 500,
      digits: 0,
    }),
    numberField({
      label: "Seed",
      unit: "",
      value: form.seed,
      set: form.seed.set,
      least: 0,
      most: 2 ** 31,
      digits: 0,
    }),
    titleField(form),
  );
}

function startChoice(form: Form, offers: OptimizeOffers): HTMLElement {
  const starts = offers.starts.map((start) => [start.name, start.told] as const);
  const options = () =>
    form.space() === "paper" ? [["", "what the engine suggests"] as const, ...starts] : starts;
  return choice({
    label: form.space() === "paper" ? "Start from" : "Vary",
    options: options(),
    value: form.start,
    set: form.start.set,
  });
}

/** What simulated people scored before: with it an engine that learns begins where most of them did best. */
function othersChoice(form: Form, offers: OptimizeOffers): HTMLElement {
  if (!offers.others.length)
    return h(
      "p",
      { class: "muted" },
      "A run may start from the scores of simulated people; in simulation, that saves more than half of the trials. In this project's folder: ",
      h("code", {}, "fdvv optimize population others/easy --people 24 --grid 512 --level easy"),
      ".",
    );
  return choice({
    label: "Others",
    options: [["", "start from scratch"], ...options(offers.others)],
    value: form.others,
    set: form.others.set,
  });
}

function scoredFields(form: Form, offers: OptimizeOffers): HTMLElement[] {
  const levels = offers.levels.map(
    (one) => [one.name as "easy" | "hard", `${one.name}: ${one.told}`] as const,
  );
  const also = (name: string) => (on: boolean) =>
    form.also.update((now) => (on ? [...now, name] : now.filter((one) => one !== name)));
  return [
    choice({ label: "Level", options: levels, value: form.level, set: form.level.set }),
    numberField({
      label: "Score after",
      unit: "presses",
      value: form.presses,
      set: form.presses.set,
      least: 2,
      most: 100,
      digits: 0,
    }),
    ...offers.objectives.map((objective) =>
      toggle({
        label: `also: ${objective.told}`,
        value: () => form.also().includes(objective.name),
        set: also(objective.name),
        hint: "Several objectives give a Pareto front to choose from",
      }),
    ),
  ];
}

function titleField(form: Form): HTMLElement {
  const input: HTMLInputElement = h("input", {
    type: "text",
    id: "opt-title",
    maxlength: 100,
    autocomplete: "off",
    on: { input: () => form.title.set(input.value.trim()) },
  });
  return h("span", { class: "field" }, h("label", { for: "opt-title" }, "Name"), input);
}

function options(offers: readonly Offer[]): (readonly [string, string])[] {
  return offers.map(
    (offer) => [offer.name, offer.told ? `${offer.name}: ${offer.told}` : offer.name] as const,
  );
}
