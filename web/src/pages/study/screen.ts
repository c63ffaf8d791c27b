/** Which screen is shown, and what lies over it while nothing can be answered. */

import { button, type Child, computed, h, signal } from "../../ui";
import { beginScreen } from "./begin";
import { formScreen } from "./form";
import { breakScreen, endScreen } from "./rest";
import type { StudySession } from "./session";
import { trialScreen } from "./trial";
import { type Word, word } from "./words";

export function studyScreen(session: StudySession): Child {
  const say = (key: Word) => () => word(session.language(), key);
  return [
    h("div", { class: "study-top" }, () => top(session)),
    h("div", { class: "study-main" }, shownScreen(session)),
    h("p", { class: "study-reason wrong", role: "alert" }, () =>
      session.standing() === "stopped" ? "" : session.reason(),
    ),
    h(
      "div",
      { class: "study-veil", role: "alert", hidden: () => !session.lost() && !session.paused() },
      h("p", {}, () => (session.lost() ? say("lost")() : say("paused")())),
    ),
  ];
}

/** Anew for every step, not for every word in it. */
function shownScreen(session: StudySession): Child {
  const key = computed(() =>
    [
      session.standing(),
      session.language(),
      session.draft()?.task.number,
      session.step()?.kind,
      session.step()?.form?.name,
    ].join("|"),
  );
  return () => {
    key();
    return screenOf(session);
  };
}

function screenOf(session: StudySession): Child {
  const standing = session.standing.peek();
  const step = session.step.peek();
  const language = session.language.peek();
  if (standing === "opening") return h("p", { class: "muted" }, "…");
  if (standing === "look") return beginScreen(session);
  if (standing === "card") return cardScreen(session);
  if (standing === "stopped" || !step) return endScreen(word(language, "stopped"), session.reason.peek());
  if (step.form) return formScreen(session, step.form);
  const draft = session.draft.peek();
  if (draft) return trialScreen(session, draft);
  if (step.kind === "break") return breakScreen(session);
  return step.kind === "done"
    ? endScreen(word(language, "doneTitle"), word(language, "doneText"))
    : endScreen(word(language, "goneTitle"), word(language, "goneText"));
}

function cardScreen(session: StudySession): HTMLElement {
  const card = session.card.peek();
  const language = session.language.peek();
  return h(
    "section",
    { class: "study-sheet", "aria-labelledby": "study-card" },
    h("h1", { id: "study-card" }, word(language, "cardTitle")),
    h("p", {}, word(language, "cardText")),
    h(
      "dl",
      { class: "study-card" },
      h(
        "div",
        {},
        h("dt", {}, word(language, "person")),
        h("dd", { "data-card": "person" }, card?.person ?? ""),
      ),
      h("div", {}, h("dt", {}, word(language, "code")), h("dd", { "data-card": "code" }, card?.code ?? "")),
    ),
    h(
      "div",
      { class: "row" },
      button({ label: word(language, "cardNoted"), kind: "main", act: () => session.noted() }),
    ),
  );
}

/** How far it is, and the way out. */
function top(session: StudySession): Child {
  const step = session.step();
  if (session.standing() !== "step" || !step) return null;
  const language = session.language();
  const over = step.kind === "done" || step.kind === "declined" || step.kind === "withdrawn";
  return [
    h("progress", {
      class: "study-progress",
      max: 1,
      value: step.progress_ratio,
      "aria-label": progressText(session),
    }),
    h(
      "div",
      { class: "row spread" },
      h("strong", { class: "study-at", "aria-live": "polite" }, progressText(session)),
      h("span", { class: "row" }, fullScreen(language), over ? null : leaving(session)),
    ),
  ];
}

function progressText(session: StudySession): string {
  const task = session.step()?.task;
  const language = session.language();
  if (!task) return session.about()?.titles[language] ?? "";
  const key = session.step()?.kind === "practice" ? "practice" : task.of ? "trial" : "trialOpen";
  return word(language, key, { at: task.at, of: task.of });
}

function fullScreen(language: string): HTMLElement | null {
  if (!document.fullscreenEnabled || document.fullscreenElement) return null;
  return button({
    label: word(language, "fullScreen"),
    kind: "quiet",
    act: () => void document.documentElement.requestFullscreen(),
  });
}

function leaving(session: StudySession): HTMLElement {
  const sure = signal(false);
  const say = (key: Word) => word(session.language.peek(), key);
  const yes = () => {
    sure.set(false);
    session.withdraw();
  };
  // the keys of the trial behind it must not be meant
  const open = () => {
    sure.set(true);
    document.querySelector<HTMLElement>(".study-veil.ask .button")?.focus();
  };
  const ask = () =>
    h(
      "div",
      { class: "study-veil ask", role: "alertdialog", "aria-label": say("leave") },
      h(
        "div",
        { class: "study-sheet" },
        h("p", {}, say("leaveSure")),
        h(
          "div",
          { class: "row" },
          button({ label: say("leaveNo"), kind: "main", act: () => sure.set(false) }),
          button({ label: say("leaveYes"), kind: "danger", act: yes }),
        ),
      ),
    );
  return h("span", {}, button({ label: say("leave"), kind: "quiet", act: open }), () =>
    sure() ? ask() : null,
  );
}
