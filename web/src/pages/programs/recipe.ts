/** A recipe's numbers over a button of choice: a program at once. */

import { go } from "../../app/route";
import { call } from "../../net";
import type { ProgramParameter, ProgramRecipe } from "../../net/messages";
import { button, choice, computed, effect, h, numberField, type Signal, signal, tell } from "../../ui";
import { bases } from "./server";

const UNITS: readonly (readonly [string, string])[] = [
  ["_mm_s", "mm/s"],
  ["_per_m_s", "per m/s"],
  ["_mm", "mm"],
  ["_cN", "cN"],
  ["_ms", "ms"],
];

/** How many levels multi-level has unless a person says otherwise. */
const LEVELS = 3;

/** Return the words and the unit of a parameter's name, whose last part is the unit. */
export function wordsOf(name: string): { readonly label: string; readonly unit: string } {
  const [ending, unit] = UNITS.find(([held]) => name.endsWith(held)) ?? ["", ""];
  const label = name.slice(0, name.length - ending.length).replaceAll("_", " ");
  return { label: label.charAt(0).toUpperCase() + label.slice(1), unit };
}

/** Return a step that suits a range. */
export function stepOf(parameter: ProgramParameter): number {
  if (parameter.whole) return parameter.high > 100 ? 10 : 1;
  return parameter.high - parameter.low > 20 ? 5 : 0.05;
}

/** A form for one recipe. */
export function recipeForm(recipe: ProgramRecipe): HTMLElement {
  const base = signal("builtin:mx-red");
  const parameters = signal(recipe.parameters);
  const values = signal<Readonly<Record<string, number>>>({});
  const levels = computed(() => values().levels ?? LEVELS);
  effect(() => {
    const asked = { recipe: recipe.name, base: base(), levels: levels() };
    if (recipe.parameters.length > 0)
      call("program.ranges", asked).then((found) => parameters.set(found.parameters), tell);
  });
  const make = async (): Promise<void> => {
    const made = await call("program.recipe", {
      recipe: recipe.name,
      base: base.peek(),
      parameters: values.peek(),
    });
    const kept = await call("program.keep", { text: made.text });
    go("programs", kept.program);
  };
  return h(
    "article",
    { class: "card", "aria-label": `Recipe ${recipe.name}` },
    h("h3", {}, recipe.name),
    h("p", {}, recipe.summary),
    h(
      "details",
      {},
      h("summary", {}, "What the parameters mean"),
      h("p", { class: "muted" }, recipe.details),
    ),
    h("span", {}, () => choice({ label: "Based on", options: bases(), value: base, set: base.set })),
    h(
      "div",
      { class: "grid" },
      recipe.parameters.map((first, i) => parameterField(first, () => parameters()[i] ?? first, values)),
    ),
    button({
      label: "Create",
      kind: "main",
      hint: `Make ${recipe.name}`,
      act: () => void make().catch(tell),
    }),
  );
}

function parameterField(
  first: ProgramParameter,
  now: () => ProgramParameter,
  values: Signal<Readonly<Record<string, number>>>,
): HTMLElement {
  const { label, unit } = wordsOf(first.name);
  // bounds follow the button, so they are looked up when a number is set
  const field = numberField({
    label,
    unit,
    digits: first.whole ? 0 : 3,
    step: stepOf(first),
    value: () => values()[first.name] ?? first.default,
    set: (value) =>
      values.update((held) => ({
        ...held,
        [first.name]: clamp(first.whole ? Math.round(value) : value, now()),
      })),
  });
  const range = h("span", { class: "muted range" }, () => `${tidy(now().low)} to ${tidy(now().high)}`);
  return h("span", { class: "parameter" }, field, range);
}

function clamp(value: number, { low, high }: ProgramParameter): number {
  return Math.min(high, Math.max(low, value));
}

function tidy(value: number): string {
  return String(Math.round(value * 1000) / 1000);
}
