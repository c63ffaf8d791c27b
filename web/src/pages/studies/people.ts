/** Who takes part and how far they are; a free seat, a pause, a way out. */

import { address } from "../../app/route";
import { call } from "../../net";
import type { StudiesDevice, StudiesPerson } from "../../net/messages";
import { button, type Child, choice, computed, empty, h, signal, tell, toast, toggle } from "../../ui";
import { secret } from "./plan";
import type { StudyStore } from "./store";

const TWIN = "twin";

export function peopleView(store: StudyStore, toPlan: () => void): HTMLElement {
  const state = store.detail.peek()?.row.state ?? "draft";
  if (state === "draft")
    return empty(
      "Not frozen yet",
      "Freeze the study before the first participant starts.",
      button({ label: "To the plan", kind: "main", act: toPlan }),
    );
  const leaving = signal<string>("");
  // not anew with every change of the study: a link that was made stays
  const open = computed(() => store.detail()?.open ?? false);
  return h(
    "div",
    { class: "sts-page" },
    state === "frozen" ? () => (open() ? seats(store) : openSessions(store)) : null,
    h(
      "section",
      { class: "panel", "aria-label": "People" },
      h("div", { class: "row spread" }, h("h2", {}, "People"), pauseAll(store)),
      () => table(store, leaving.set),
    ),
    () => (leaving() ? withdrawal(store, leaving(), () => leaving.set("")) : null),
  );
}

/** The key holder lets sessions run, after every start of the studio. */
function openSessions(store: StudyStore): HTMLElement {
  const pass = secret("sts-run", "Passphrase of the key holder");
  const file = h("input", { id: "sts-keeper", type: "file", accept: ".json" });
  const busy = signal(false);
  const submit = async (event: Event) => {
    event.preventDefault();
    busy.set(true);
    const keeper = (await file.files?.[0]?.text()) ?? "";
    const ask = { study: store.study, passphrase: pass.input.value, keeper };
    await store.act(() => call("studies.open", ask));
    busy.set(false);
  };
  return h(
    "form",
    { class: "panel", "aria-label": "Open the sessions", on: { submit: (event) => void submit(event) } },
    h("h2", {}, "Open the sessions"),
    h(
      "p",
      { class: "muted" },
      "No code opens what the labels hide. The key holder lets sessions run until this studio ends: participants can begin, and those who wait go on. It is recorded.",
    ),
    h(
      "div",
      { class: "sts-fields" },
      pass.element,
      h("span", { class: "field" }, h("label", { for: "sts-keeper" }, "keeper.json, if it was moved"), file),
    ),
    h(
      "div",
      { class: "row" },
      h("button", { type: "submit", class: "button main", disabled: busy }, () =>
        busy() ? "Opening …" : "Open the sessions",
      ),
    ),
  );
}

function seats(store: StudyStore): HTMLElement {
  const made = signal("");
  const make = async () => {
    try {
      const { seat } = await call("studies.seat", { study: store.study });
      await store.refresh();
      made.set(`${location.origin}/?seat=${seat}${address("study", store.study)}`);
    } catch (error) {
      tell(error);
    }
  };
  const copy = () =>
    void navigator.clipboard.writeText(made.peek()).then(() => toast("Copied", "done"), tell);
  const shown = (link: string) => [
    h(
      "div",
      { class: "row sts-link" },
      h("a", { href: link, target: "_blank", rel: "noopener", "data-seat": "" }, link),
      button({ label: "Copy", act: copy }),
    ),
    h(
      "p",
      { class: "muted" },
      "Open it on the participant's device: it opens this screen and nothing else of the studio, and the first page that starts uses up the invitation. It holds after a restart of the studio. A participant with a card can resume there with its number and code.",
    ),
  ];
  return h(
    "section",
    { class: "panel", "aria-label": "Invitation" },
    h("h2", {}, "Next participant"),
    deviceChoice(store),
    h(
      "div",
      { class: "row" },
      button({ label: "Create an invitation", kind: "main", act: () => void make() }),
      h("span", { class: "muted" }, () => waitingText(store)),
    ),
    h("div", { class: "sts-page" }, () => (made() && store.detail()?.waiting ? shown(made()) : null)),
  );
}

/** What is pressed: the twin on the screen, or a device on the table; from the next trial on. */
function deviceChoice(store: StudyStore): HTMLElement {
  const there = signal<readonly StudiesDevice[]>([]);
  // asked once: serial ports are looked for
  void call("studies.devices", {}).then((answer) => there.set(answer.devices), tell);
  const use = (device: string) => void store.act(() => call("studies.use", { study: store.study, device }));
  const value = () => store.detail()?.device ?? TWIN;
  return h("div", { class: "sts-device" }, () =>
    choice({
      label: "Rendered by",
      options: known(there(), value()).map((one) => [one.name, one.about] as const),
      value,
      set: use,
    }),
  );
}

/** What there is, and what was chosen before though it is not there now. */
function known(there: readonly StudiesDevice[], chosen: string): readonly StudiesDevice[] {
  return there.some((one) => one.name === chosen)
    ? there
    : [...there, { name: chosen, about: there.length ? `${chosen} (not there now)` : chosen }];
}

function waitingText(store: StudyStore): string {
  const waiting = store.detail()?.waiting ?? 0;
  return waiting ? `${waiting} ${waiting === 1 ? "invitation is" : "invitations are"} unused` : "";
}

function pauseAll(store: StudyStore): HTMLElement {
  const set = (on: boolean) =>
    void store.act(() => call("studies.pause", { study: store.study, person: null, on }));
  return toggle({
    label: "Pause all",
    value: () => store.detail()?.paused ?? false,
    set,
    hint: "Their screens wait; no answers are lost",
  });
}

function table(store: StudyStore, leave: (person: string) => void): Child {
  const people = store.detail()?.people ?? [];
  if (!people.length) return h("p", { class: "muted" }, "No participant has started yet.");
  const heads = ["Person", "Language", "Where", "Trials", "", ""];
  return h(
    "div",
    { class: "sts-scroll" },
    h(
      "table",
      { class: "sts-people" },
      h(
        "thead",
        {},
        h(
          "tr",
          {},
          heads.map((text) => h(text ? "th" : "td", {}, text)),
        ),
      ),
      h(
        "tbody",
        {},
        people.map((one) => row(store, one, leave)),
      ),
    ),
  );
}

function row(store: StudyStore, one: StudiesPerson, leave: (person: string) => void): HTMLElement {
  const gone = one.state === "withdrawn" || one.state === "declined" || one.state === "deleted";
  const pause = () =>
    void store.act(() => call("studies.pause", { study: store.study, person: one.person, on: !one.paused }));
  return h(
    "tr",
    { "data-person": one.person },
    h("th", { scope: "row" }, one.person),
    h("td", {}, one.language),
    h(
      "td",
      { class: "sts-where" },
      h("i", { class: one.here ? "here" : "", "aria-hidden": "true" }),
      one.here ? `${one.state}, at a screen` : one.state,
      one.told ? h("span", { class: "tag simulated" }, one.told) : null,
    ),
    h(
      "td",
      { class: "sts-progress" },
      h("progress", {
        class: "progress",
        max: Math.max(1, one.trials),
        value: one.answered,
        "aria-label": `Trials of ${one.person}`,
      }),
      h("span", {}, `${one.answered} of ${one.trials}`),
    ),
    h(
      "td",
      {},
      gone || one.state === "done" ? null : button({ label: one.paused ? "Go on" : "Pause", act: pause }),
    ),
    h(
      "td",
      {},
      one.state === "deleted"
        ? null
        : button({ label: "Withdraw", kind: "danger", act: () => leave(one.person) }),
    ),
  );
}

function withdrawal(store: StudyStore, person: string, done: () => void): HTMLElement {
  const del = signal(true);
  const act = async () => {
    if (await store.act(() => call("studies.withdraw", { study: store.study, person, delete: del.peek() })))
      done();
  };
  return h(
    "section",
    { class: "panel sts-danger", role: "alertdialog", "aria-label": `Withdraw ${person}` },
    h("h2", {}, `Withdraw ${person}`),
    h("p", {}, "This cannot be undone. The record still shows that they took part and withdrew."),
    toggle({ label: "Delete their answers from the disk", value: del, set: del.set }),
    h(
      "div",
      { class: "row" },
      button({ label: `Withdraw ${person} permanently`, kind: "danger", act: () => void act() }),
      button({ label: "Cancel", act: done }),
    ),
  );
}
