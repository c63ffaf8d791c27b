/** Before anybody sits here: language, a free seat, or a card. */

import { button, choice, h, signal } from "../../ui";
import type { StudySession } from "./session";
import { languageName, word } from "./words";

export function beginScreen(session: StudySession): HTMLElement {
  const language = session.language.peek();
  const about = session.about.peek();
  const carded = signal(!about?.seat);
  const say = (key: Parameters<typeof word>[1]) => word(language, key);
  return h(
    "section",
    { class: "study-sheet", "aria-labelledby": "study-title" },
    h("h1", { id: "study-title" }, about?.titles[language] ?? ""),
    about && about.languages.length > 1
      ? choice({
          label: say("language"),
          options: about.languages.map((language) => [language, languageName(language)] as const),
          value: session.language,
          set: session.language.set,
        })
      : null,
    about?.seat ? null : h("p", { class: "muted" }, say("noSeat")),
    () =>
      carded()
        ? cardForm(session)
        : h(
            "div",
            { class: "row" },
            button({
              label: say("begin"),
              kind: "main",
              act: () => session.sit(),
              disabled: session.waiting,
            }),
            button({ label: say("haveCard"), kind: "quiet", act: () => carded.set(true) }),
          ),
  );
}

function cardForm(session: StudySession): HTMLElement {
  const say = (key: Parameters<typeof word>[1]) => word(session.language.peek(), key);
  const person = h("input", {
    id: "study-person",
    type: "text",
    maxlength: 20,
    autocomplete: "off",
    spellcheck: "false",
  });
  const code = h("input", {
    id: "study-code",
    type: "text",
    maxlength: 40,
    autocomplete: "off",
    spellcheck: "false",
  });
  const submit = (event: Event) => {
    event.preventDefault();
    session.resume(person.value.trim(), code.value.trim());
  };
  return h(
    "form",
    { class: "study-form", on: { submit } },
    h("label", { for: "study-person" }, say("person")),
    person,
    h("label", { for: "study-code" }, say("code")),
    code,
    h("div", { class: "row" }, h("button", { type: "submit", class: "button main" }, say("goOn"))),
  );
}
