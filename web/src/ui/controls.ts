/** Controls that every page uses, each with its label and its unit. */

import { type Child, h } from "./element";
import { effect } from "./signal.svelte";

let made = 0;
/** Return an id that no other element has. */
export function freshId(kind: string): string {
  return `${kind}-${++made}`;
}

export interface ButtonOptions {
  readonly label: string;
  readonly act: () => void;
  /** Shown instead of the label, which then names the button for screen readers and as a hint. */
  readonly glyph?: string;
  readonly kind?: "plain" | "main" | "quiet" | "danger";
  readonly hint?: string;
  readonly disabled?: boolean | (() => boolean);
  /** For buttons that stay down. */
  readonly pressed?: () => boolean;
}

export function button(o: ButtonOptions): HTMLButtonElement {
  return h(
    "button",
    {
      type: "button",
      class: `button ${o.kind ?? "plain"}${o.glyph ? " glyph" : ""}`,
      title: o.hint ?? (o.glyph ? o.label : null),
      "aria-label": o.glyph ? o.label : null,
      "aria-pressed": o.pressed ? () => String(o.pressed?.()) : null,
      disabled: o.disabled ?? false,
      on: { click: o.act },
    },
    o.glyph ?? o.label,
  );
}

export interface NumberOptions {
  readonly label: string;
  readonly unit: string;
  readonly value: () => number | null;
  /** Called when a number was entered that is within bounds. */
  readonly set: (value: number) => void;
  readonly step?: number;
  readonly least?: number;
  readonly most?: number;
  /** Decimals that are shown. */
  readonly digits?: number;
  /** The label is for screen readers only. */
  readonly bare?: boolean;
  readonly disabled?: () => boolean;
}

/** A number with its unit: typed and confirmed with Enter or by leaving; Escape takes it back. */
export function numberField(o: NumberOptions): HTMLElement {
  const id = freshId("number");
  const input = h("input", {
    id,
    type: "text",
    inputmode: "decimal",
    autocomplete: "off",
    spellcheck: "false",
    disabled: o.disabled ?? false,
    "aria-label": o.bare ? `${o.label}, ${o.unit}` : null,
  });
  const wrong = h("span", { class: "wrong", role: "alert" });
  const show = () => {
    const value = o.value();
    input.value = value === null ? "" : shown(value, o.digits);
    say("");
  };
  const say = (text: string) => {
    wrong.textContent = text;
    input.toggleAttribute("aria-invalid", text !== "");
  };
  const commit = () => {
    const typed = input.value.trim().replace(",", ".").replace("−", "-");
    const now = o.value();
    if (typed === (now === null ? "" : shown(now, o.digits))) return say("");
    const value = Number(typed);
    const fault = typed === "" || !Number.isFinite(value) ? "not a number" : outside(value, o);
    if (fault) return say(fault);
    o.set(value);
    show();
  };
  input.addEventListener("change", commit);
  input.addEventListener("keydown", (event) => {
    if (event.key === "Enter") commit();
    else if (event.key === "Escape") show();
    else if (event.key === "ArrowUp" || event.key === "ArrowDown") {
      const step = (o.step ?? 1) * (event.shiftKey ? 10 : event.altKey ? 0.1 : 1);
      const value = (o.value() ?? 0) + (event.key === "ArrowUp" ? step : -step);
      event.preventDefault();
      if (!outside(value, o)) o.set(value);
      show();
    }
  });
  effect(show);
  return h(
    "span",
    { class: "field number" },
    o.bare ? null : h("label", { for: id }, o.label),
    h("span", { class: "with-unit" }, input, h("span", { class: "unit", "aria-hidden": "true" }, o.unit)),
    wrong,
  );
}

export function outside(
  value: number,
  o: { unit: string; least?: number | undefined; most?: number | undefined },
): string {
  if (o.least !== undefined && value < o.least) return `at least ${o.least} ${o.unit}`;
  if (o.most !== undefined && value > o.most) return `at most ${o.most} ${o.unit}`;
  return "";
}

/** Write a number with at most so many decimals, without trailing zeros, with a true minus sign. */
export function shown(value: number, digits = 2): string {
  const text = Number(value.toFixed(digits)).toString();
  return text.replace("-", "−");
}

export interface ChoiceOptions<T extends string> {
  readonly label: string;
  readonly options: readonly (readonly [T, string])[];
  readonly value: () => T;
  readonly set: (value: T) => void;
  readonly bare?: boolean;
}

export function choice<T extends string>(o: ChoiceOptions<T>): HTMLElement {
  const id = freshId("choice");
  const select = h(
    "select",
    {
      id,
      "aria-label": o.bare ? o.label : null,
      on: { change: () => o.set(select.value as T) },
    },
    o.options.map(([value, text]) => h("option", { value }, text)),
  );
  effect(() => {
    select.value = o.value();
  });
  return h("span", { class: "field" }, o.bare ? null : h("label", { for: id }, o.label), select);
}

export interface ToggleOptions {
  readonly label: string;
  readonly value: () => boolean;
  readonly set: (value: boolean) => void;
  readonly hint?: string;
}

export function toggle(o: ToggleOptions): HTMLElement {
  const input: HTMLInputElement = h("input", {
    type: "checkbox",
    on: { change: () => o.set(input.checked) },
  });
  effect(() => {
    input.checked = o.value();
  });
  return h("label", { class: "toggle", title: o.hint ?? null }, input, h("span", {}, o.label));
}

/** A titled part of a page. */
export function panel(title: string, ...content: Child[]): HTMLElement {
  const id = freshId("panel");
  return h(
    "section",
    { class: "panel", "aria-labelledby": id },
    h("h2", { id }, title),
    h("div", { class: "panel-body" }, content),
  );
}

/** What to say where there is nothing yet, and what to do next. */
export function empty(title: string, text: string, ...actions: Child[]): HTMLElement {
  return h(
    "div",
    { class: "empty" },
    h("h2", {}, title),
    h("p", {}, text),
    h("div", { class: "row" }, actions),
  );
}

/** How far long work is; of unknown length where total is null. */
export function progress(label: string, done: () => number, total: () => number | null): HTMLElement {
  return h("progress", {
    class: "progress",
    "aria-label": label,
    max: () => total() ?? 1,
    ref: (element) =>
      effect(() => {
        const all = total();
        if (all === null) element.removeAttribute("value");
        else element.setAttribute("value", String(done()));
      }),
  });
}

export interface TabOptions<T extends string> {
  readonly label: string;
  readonly tabs: readonly (readonly [T, string])[];
  readonly value: () => T;
  readonly set: (value: T) => void;
}

/** A row of tabs; the page shows what belongs to the chosen one. Arrow keys move between them. */
export function tabs<T extends string>(o: TabOptions<T>): HTMLElement {
  const move = (event: KeyboardEvent, at: number) => {
    const by = event.key === "ArrowRight" ? 1 : event.key === "ArrowLeft" ? -1 : 0;
    const next = o.tabs[(at + by + o.tabs.length) % o.tabs.length];
    if (!by || !next) return;
    event.preventDefault();
    o.set(next[0]);
    (row.children[o.tabs.indexOf(next)] as HTMLElement).focus();
  };
  const row = h(
    "div",
    { class: "tabs", role: "tablist", "aria-label": o.label },
    o.tabs.map(([value, text], at) =>
      h(
        "button",
        {
          type: "button",
          role: "tab",
          "aria-selected": () => String(o.value() === value),
          tabindex: () => (o.value() === value ? 0 : -1),
          on: { click: () => o.set(value), keydown: (event) => move(event, at) },
        },
        text,
      ),
    ),
  );
  return row;
}
