/** One trial: switch freely between labels, press, answer. */

import type { StudyScale, StudyTask } from "../../net/messages";
import { addShortcuts, button, type Child, h, type Shortcut } from "../../ui";
import { type Draft, EQUAL, MOST_BUTTONS } from "./answer";
import { feelView } from "./feel";
import type { StudySession } from "./session";
import { listed, word } from "./words";

export function trialScreen(session: StudySession, draft: Draft): HTMLElement {
  const { task } = draft;
  const language = session.language.peek();
  const places = listed(task.places);
  const view = feelView(session, () =>
    word(language, session.onTable() ? "tableHint" : "pressHint", { places }),
  );
  const go = (label: string) => {
    session.go(label);
    view.focus({ preventScroll: true });
  };
  addShortcuts(...keys(session, draft, go));
  return h(
    "section",
    { class: "study-trial", "aria-labelledby": "study-question" },
    h(
      "div",
      { class: "study-ask" },
      h("p", { class: "muted" }, task.item),
      h("h1", { id: "study-question" }, task.question),
    ),
    h(
      "div",
      { class: "study-left" },
      h(
        "div",
        { class: "study-places", role: "group", "aria-label": places },
        task.places.map((label) => place(session, draft, label, go)),
      ),
      view,
    ),
    h(
      "div",
      { class: "study-right" },
      task.choices.length ? chooser(draft, language) : null,
      task.scales.map((scale) => rater(draft, scale)),
      foot(session, draft),
    ),
  );
}

function place(session: StudySession, draft: Draft, label: string, go: (label: string) => void): HTMLElement {
  const there = () => (session.going() || session.felt()) === label;
  const pressed = () => draft.felt().has(label);
  return h(
    "button",
    {
      type: "button",
      class: () => `button study-place${pressed() ? " pressed" : ""}`,
      "aria-pressed": () => String(there()),
      "data-label": label,
      "data-felt": () => String(session.felt() === label),
      "data-pressed": () => String(pressed()),
      on: { click: () => go(label) },
    },
    label,
    h("i", { "aria-hidden": "true" }, () => (pressed() ? "✓" : "")),
  );
}

function chooser(draft: Draft, language: string): HTMLElement {
  const { task } = draft;
  const [first, ...others] = task.choices;
  const options: readonly (readonly [string, string])[] = [
    [first ?? "", first ?? ""],
    ...(task.equal ? [[EQUAL, task.equal] as const] : []),
    ...others.map((label) => [label, label] as const),
  ];
  return h(
    "fieldset",
    { class: "study-field" },
    h("legend", {}, word(language, "choose")),
    h(
      "div",
      { class: "study-choices" },
      options.map(([value, text]) =>
        radio(
          "study-choice",
          value,
          text,
          () => draft.choice() === value,
          () => draft.choose(value),
        ),
      ),
    ),
  );
}

function radio(
  name: string,
  value: string,
  text: string,
  chosen: () => boolean,
  choose: () => void,
): HTMLElement {
  const input: HTMLInputElement = h("input", {
    type: "radio",
    name,
    value,
    checked: chosen,
    on: { change: choose },
  });
  return h("label", { class: "study-radio" }, input, h("span", {}, text));
}

function rater(draft: Draft, scale: StudyScale): HTMLElement {
  const row = scale.points <= MOST_BUTTONS ? buttons : slider;
  return h(
    "div",
    { class: "study-field" },
    h("p", { class: "study-scale" }, scale.question),
    h(
      "div",
      { class: "study-ends", "aria-hidden": "true" },
      h("span", {}, scale.low),
      h("span", {}, scale.high),
    ),
    draft.task.rated.map((label) => row(draft, scale, label)),
  );
}

function buttons(draft: Draft, scale: StudyScale, label: string): HTMLElement {
  const points = Array.from({ length: scale.points }, (_, i) => i + 1);
  const given = () => draft.ratings()[scale.name]?.[label];
  return h(
    "div",
    { class: "study-rating", role: "radiogroup", "aria-label": `${scale.question} ${label}` },
    h("strong", { "aria-hidden": "true" }, label),
    points.map((n) =>
      radio(
        `study-${scale.name}-${label}`,
        String(n),
        String(n),
        () => given() === n,
        () => draft.rate(scale.name, label, n),
      ),
    ),
  );
}

function slider(draft: Draft, scale: StudyScale, label: string): HTMLElement {
  const given = () => draft.ratings()[scale.name]?.[label];
  const take = () => draft.rate(scale.name, label, Number(input.value));
  const input: HTMLInputElement = h("input", {
    type: "range",
    min: 0,
    max: scale.points - 1,
    step: 1,
    value: () => given() ?? (scale.points - 1) / 2,
    class: () => (given() === undefined ? "unset" : ""),
    "aria-label": `${scale.question} ${label}`,
    "aria-valuetext": () => String(given() ?? "–"),
    on: { input: take, pointerup: take },
  });
  return h(
    "div",
    { class: "study-slider" },
    h("strong", { "aria-hidden": "true" }, label),
    input,
    h("output", {}, () => String(given() ?? "–")),
  );
}

function foot(session: StudySession, draft: Draft): Child {
  const language = session.language.peek();
  const lacking = () =>
    draft.unfelt().length ? word(language, "feltHint", { places: listed(draft.unfelt()) }) : "";
  return [
    h(
      "div",
      { class: "row spread study-foot" },
      h("p", { class: "muted", role: "status" }, lacking),
      button({
        label: word(language, "next"),
        kind: "main",
        act: () => session.answer(),
        disabled: () => !draft.complete() || session.waiting() || session.lost() || session.paused(),
      }),
    ),
    h("p", { class: "muted study-keys" }, () => keysText(draft.task, language, session.onTable())),
  ];
}

function keysText(task: StudyTask, language: string, table: boolean): string {
  const digits = task.scales.some((scale) => scale.points <= MOST_BUTTONS)
    ? word(language, "keysDigits")
    : "";
  const choices = task.choices.length ? word(language, task.equal ? "keysEqual" : "keysChoices") : "";
  return word(language, table ? "tableKeys" : "keys", { places: task.places.join(", "), digits, choices });
}

function keys(session: StudySession, draft: Draft, go: (label: string) => void): Shortcut[] {
  const { task } = draft;
  const felt = () => session.felt.peek();
  const free = () => !session.lost.peek() && !session.paused.peek();
  const one = (key: string, does: string, act: () => void): Shortcut => ({
    keys: key,
    does,
    act: () => free() && act(),
    always: true,
  });
  return [
    ...task.places.map((label) => one(label, `Feel ${label}`, () => go(label))),
    ...task.choices.map((label) => one(`Shift+${label}`, `Choose ${label}`, () => draft.choose(label))),
    ...(task.equal ? [one("E", "Choose equal", () => draft.choose(EQUAL))] : []),
    ...Array.from({ length: 9 }, (_, i) =>
      one(String(i + 1), `Rate ${i + 1}`, () => draft.rateFelt(felt(), i + 1)),
    ),
    one("Enter", "Go on", () => session.answer()),
  ];
}
