/** Fields that the inspector uses in several places. */

import { condition, conditionValue, KINDS, kindOf } from "../../programs/condition";
import { type Condition, type ConditionKind, nameProblem } from "../../programs/document";
import { choice, freshId, h, numberField } from "../../ui";

/** A line of text with a label; an error is shown beside it, and then nothing is set. */
export function textField(o: {
  readonly label: string;
  readonly value: () => string;
  readonly set: (text: string) => void;
  readonly problem?: (text: string) => string | null;
}): HTMLElement {
  const id = freshId("text");
  const wrong = h("span", { class: "wrong", role: "alert" });
  const commit = (): void => {
    const text = input.value;
    const fault = text === o.value() ? null : (o.problem?.(text) ?? null);
    wrong.textContent = fault ?? "";
    input.toggleAttribute("aria-invalid", fault !== null);
    if (fault === null && text !== o.value()) o.set(text);
  };
  const input: HTMLInputElement = h("input", {
    id,
    type: "text",
    autocomplete: "off",
    spellcheck: "false",
    value: o.value,
    on: {
      change: commit,
      keydown: (event) => {
        if (event.key === "Enter") commit();
        if (event.key === "Escape") input.value = o.value();
      },
    },
  });
  return h("span", { class: "field wide" }, h("label", { for: id }, o.label), input, wrong);
}

/** A field for the name of a part that has others beside it. */
export function nameField(
  label: string,
  value: string,
  others: () => readonly string[],
  set: (name: string) => void,
): HTMLElement {
  const problem = (text: string): string | null =>
    nameProblem(
      text,
      others().filter((name) => name !== value),
    );
  return textField({ label, value: () => value, set, problem });
}

/** Choose one of names, or none. */
export function nameChoice(
  label: string,
  names: readonly string[],
  value: () => string | null | undefined,
  set: (name: string | null) => void,
  none = "nothing",
): HTMLElement {
  const options = [["", none] as const, ...names.map((name) => [name, name] as const)];
  return choice({ label, options, value: () => value() ?? "", set: (name) => set(name || null) });
}

/** A condition: its kind, and its value with the unit if it takes one. */
export function conditionField(
  label: string,
  get: () => Condition | null | undefined,
  set: (get: Condition | null) => void,
  optional = false,
): HTMLElement {
  const options = [
    ...(optional ? [["", "always"] as const] : []),
    ...KINDS.map((known) => [known.kind, known.label] as const),
  ];
  const held = get();
  const kinds = choice<string>({
    label,
    options,
    value: () => (get() ? kindOf(get()!).kind : ""),
    set: (kind) => set(kind === "" ? null : condition(kind as ConditionKind)),
  });
  return h(
    "div",
    { class: "row condition" },
    kinds,
    held && conditionValue(held) !== null ? valueField(label, held, get, set) : null,
  );
}

function valueField(
  label: string,
  held: Condition,
  get: () => Condition | null | undefined,
  set: (get: Condition) => void,
): HTMLElement {
  const known = kindOf(held);
  return numberField({
    label: `${label} ${known.label}`,
    unit: known.unit,
    bare: true,
    digits: known.whole ? 0 : 4,
    least: known.low,
    most: known.high,
    step: known.unit === "mm" ? 0.05 : known.unit === "" ? 1 : 10,
    value: () => {
      const now = get();
      return now ? conditionValue(now) : null;
    },
    set: (value) => set(condition(known.kind, known.whole ? Math.round(value) : value)),
  });
}
