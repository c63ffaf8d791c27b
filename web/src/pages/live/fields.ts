/** Fields of the forms that the toolbox has not: text, and a list of speeds. */

import { effect, freshId, h, shown } from "../../ui";

export interface TextOptions {
  readonly label: string;
  readonly value: () => string;
  readonly set: (value: string) => void;
  readonly hint?: string;
}

export function textField(o: TextOptions): HTMLElement {
  const id = freshId("text");
  const input = h("input", {
    id,
    type: "text",
    autocomplete: "off",
    spellcheck: "false",
    maxlength: 80,
    title: o.hint ?? null,
    on: { input: () => o.set(input.value) },
  });
  effect(() => {
    if (input.value !== o.value()) input.value = o.value();
  });
  return h("span", { class: "field" }, h("label", { for: id }, o.label), input);
}

export interface SpeedsOptions {
  readonly label: string;
  readonly value: () => readonly number[];
  readonly set: (value: readonly number[]) => void;
  readonly least_mm_s: number;
}

const MOST_mm_s = 500;
const MOST_SPEEDS = 12;

/** Read speeds with spaces or commas between them; a line of text says what is wrong. */
export function speedsOf(text: string, least_mm_s: number): readonly number[] | string {
  const parts = text.split(/[\s,;]+/).filter(Boolean);
  const speeds = parts.map(Number);
  if (!speeds.length || speeds.length > MOST_SPEEDS) return `give 1 to ${MOST_SPEEDS} speeds`;
  if (!speeds.every((v) => Number.isFinite(v) && v >= least_mm_s && v <= MOST_mm_s)) {
    return `use numbers from ${least_mm_s} to ${MOST_mm_s} mm/s`;
  }
  if (new Set(speeds).size !== speeds.length) return "a speed is listed twice";
  return speeds;
}

/** Several speeds in one field, with commas between them. */
export function speedsField(o: SpeedsOptions): HTMLElement {
  const id = freshId("speeds");
  const wrong = h("span", { class: "wrong", role: "alert" });
  const say = (text: string) => {
    wrong.textContent = text;
    input.toggleAttribute("aria-invalid", text !== "");
  };
  const input = h("input", { id, type: "text", inputmode: "text", autocomplete: "off", spellcheck: "false" });
  input.addEventListener("change", () => {
    const found = speedsOf(input.value, o.least_mm_s);
    if (typeof found === "string") return say(found);
    say("");
    o.set(found);
  });
  effect(() => {
    input.value = o
      .value()
      .map((v) => shown(v))
      .join(", ");
  });
  const unit = h("span", { class: "unit", "aria-hidden": "true" }, "mm/s");
  return h(
    "span",
    { class: "field speeds" },
    h("label", { for: id }, o.label),
    h("span", { class: "with-unit" }, input, unit),
    wrong,
  );
}

/** A form: fields in rows, and a button that begins. */
export function form(label: string, fields: readonly (Node | null)[], actions: readonly Node[]): HTMLElement {
  return h(
    "form",
    { class: "work-form", "aria-label": label, on: { submit: (event) => event.preventDefault() } },
    h("div", { class: "work-fields" }, fields),
    h("div", { class: "row" }, actions),
  );
}
