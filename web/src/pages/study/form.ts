/** A page outside the trials: text, questions, and agreement where it is a consent page. */

import type { StudyAsked, StudyForm } from "../../net/messages";
import { button, h, signal } from "../../ui";
import type { StudySession } from "./session";
import { word } from "./words";

export function formScreen(session: StudySession, form: StudyForm): HTMLElement {
  const language = session.language.peek();
  const lacking = signal(false);
  const fields = form.questions.map((question) => field(question, language));
  const send = (agreed: boolean) => {
    const found = fields.map((field) => field.read());
    // who does not take part need not answer
    if (agreed && found.includes(undefined)) return lacking.set(true);
    const values = form.questions.flatMap((question, at) =>
      found[at] === undefined || found[at] === null ? [] : [[question.name, found[at]] as const],
    );
    session.fill(agreed ? Object.fromEntries(values) : {}, agreed);
  };
  const submit = (event: Event) => {
    event.preventDefault();
    send(true);
  };
  return h(
    "form",
    { class: "study-sheet study-form", "aria-labelledby": "study-title", novalidate: true, on: { submit } },
    h("h1", { id: "study-title" }, form.title),
    form.paragraphs.map((text) => h("p", {}, text)),
    fields.map((field) => field.element),
    h("p", { class: "wrong", role: "alert" }, () => (lacking() ? word(language, "answerAll") : "")),
    h(
      "div",
      { class: "row study-acts" },
      h(
        "button",
        { type: "submit", class: "button main", disabled: session.waiting },
        word(language, form.consent ? "agree" : "goOn"),
      ),
      form.consent
        ? button({ label: word(language, "decline"), act: () => send(false), disabled: session.waiting })
        : null,
    ),
  );
}

interface Field {
  readonly element: HTMLElement;
  /** Return what was answered: null if nothing need be, undefined if that will not do. */
  read(): string | number | null | undefined;
}

function field(asked: StudyAsked, language: string): Field {
  const note = asked.required ? "" : ` (${word(language, "optional")})`;
  if (asked.choices.length) return choices(asked, note);
  const number = asked.low !== null || asked.high !== null;
  const id = `study-${asked.name}`;
  const range =
    number && asked.low !== null && asked.high !== null
      ? word(language, "number", { low: asked.low, high: asked.high })
      : "";
  const input = h("input", {
    id,
    type: "text",
    inputmode: number ? "decimal" : "text",
    autocomplete: "off",
    maxlength: number ? 20 : 2000,
    "aria-describedby": range ? `${id}-range` : null,
  });
  const read = () => {
    const typed = input.value.trim();
    if (!typed) return asked.required ? undefined : null;
    return number ? inRange(Number(typed.replace(",", ".")), asked) : typed;
  };
  return {
    element: h(
      "div",
      { class: "study-field" },
      h("label", { for: id }, asked.question + note),
      h(
        "span",
        { class: "row" },
        input,
        range ? h("span", { id: `${id}-range`, class: "muted" }, range) : null,
      ),
    ),
    read,
  };
}

function inRange(value: number, { low, high }: StudyAsked): number | undefined {
  return Number.isFinite(value) && value >= (low ?? -Infinity) && value <= (high ?? Infinity)
    ? value
    : undefined;
}

function choices(asked: StudyAsked, note: string): Field {
  const inputs = asked.choices.map((value) =>
    h("input", { type: "radio", name: `study-${asked.name}`, value }),
  );
  const options = asked.choices.map((text, at) =>
    h("label", { class: "study-option" }, inputs[at], h("span", {}, text)),
  );
  const read = () => inputs.find((input) => input.checked)?.value ?? (asked.required ? undefined : null);
  return {
    element: h(
      "fieldset",
      { class: "study-field" },
      h("legend", {}, asked.question + note),
      h("div", { class: "study-options" }, options),
    ),
    read,
  };
}
