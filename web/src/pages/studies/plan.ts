/** The declaration: its text, what is wrong with it, what it comes to; then it is frozen. */

import { call } from "../../net";
import type { StudiesPlan, StudiesTable } from "../../net/messages";
import { button, type Child, computed, h, onCleanup, signal, tell, toast } from "../../ui";
import type { StudyStore } from "./store";

const TYPED_ms = 500;

export function planView(store: StudyStore, frozen: () => void): HTMLElement {
  const plan = signal<StudiesPlan | null>(null);
  const changed = signal(false);
  let [gone, timer, turn] = [false, 0, 0];
  onCleanup(() => {
    gone = true;
    clearTimeout(timer);
  });
  const draft = computed(() => store.detail()?.row.state === "draft");
  const text = h("textarea", {
    class: "sts-text",
    "aria-label": "study.toml",
    spellcheck: "false",
    autocomplete: "off",
    readonly: () => !draft(),
  });
  const show = (found: StudiesPlan, mine: number) => !gone && mine === turn && plan.set(found);
  const check = () =>
    void call("studies.write", { study: store.study, text: text.value, keep: false }).then(
      (
        (mine) => (found: StudiesPlan) =>
          show(found, mine)
      )(++turn),
      tell,
    );
  const keep = async () => {
    try {
      plan.set(await call("studies.write", { study: store.study, text: text.value, keep: true }));
      changed.set(false);
      toast("Plan saved", "done");
    } catch (error) {
      tell(error);
    }
  };
  text.addEventListener("input", () => {
    changed.set(true);
    clearTimeout(timer);
    timer = window.setTimeout(check, TYPED_ms);
  });
  call("studies.plan", { study: store.study }).then((found) => {
    if (gone) return;
    text.value = found.text;
    plan.set(found);
  }, tell);
  return h(
    "div",
    { class: "sts-two" },
    h(
      "section",
      { class: "panel", "aria-label": "Plan" },
      h("h2", {}, () => (draft() ? "study.toml: editable until you freeze it" : "study.toml: frozen")),
      text,
      () =>
        draft()
          ? h(
              "div",
              { class: "row" },
              button({ label: "Keep", kind: "main", act: () => void keep(), disabled: () => !changed() }),
              h("span", { class: "muted" }, () => (changed() ? "not saved yet" : "")),
            )
          : null,
    ),
    h(
      "div",
      { class: "sts-page" },
      h("section", { class: "panel", "aria-label": "Check" }, h("h2", {}, "Check"), () => checked(plan())),
      h("section", { class: "panel", "aria-label": "Preview" }, h("h2", {}, "Summary"), () =>
        preview(plan()),
      ),
      () => (draft() ? freezing(store, plan, changed, frozen) : null),
    ),
  );
}

function checked(plan: StudiesPlan | null): Child {
  if (!plan) return h("p", { class: "muted" }, "…");
  if (!plan.problems.length) return h("p", { class: "sts-good" }, "No problems found.");
  return h(
    "ul",
    { class: "sts-problems" },
    plan.problems.map((line) => h("li", {}, line)),
  );
}

function preview(plan: StudiesPlan | null): Child {
  if (plan && !plan.preview.length)
    return h("p", { class: "muted" }, "Shown when the plan has no problems and is saved.");
  return h(
    "div",
    { class: "sts-preview", tabindex: 0, role: "region", "aria-label": "Summary" },
    (plan?.preview ?? []).map((one) => [
      h("h3", {}, one.title),
      one.paragraphs.map((text) => h("p", {}, text)),
      one.tables.map(table),
    ]),
  );
}

function table(one: StudiesTable): HTMLElement {
  return h(
    "table",
    {},
    h(
      "thead",
      {},
      h(
        "tr",
        {},
        one.heads.map((text) => h("th", {}, text)),
      ),
    ),
    h(
      "tbody",
      {},
      one.rows.map((cells) =>
        h(
          "tr",
          {},
          cells.map((text) => h("td", {}, text)),
        ),
      ),
    ),
  );
}

function freezing(
  store: StudyStore,
  plan: () => StudiesPlan | null,
  changed: () => boolean,
  done: () => void,
): HTMLElement {
  const busy = signal(false);
  const first = secret("sts-pass", "Passphrase of the key holder");
  const again = secret("sts-again", "Repeat");
  const wrong = signal("");
  const submit = async (event: Event) => {
    event.preventDefault();
    if (!first.input.value) return wrong.set("enter a passphrase");
    if (first.input.value !== again.input.value) return wrong.set("the two do not match");
    wrong.set("");
    busy.set(true);
    const frozen = await store.act(() =>
      call("studies.freeze", { study: store.study, passphrase: first.input.value }),
    );
    busy.set(false);
    if (frozen) done();
  };
  const able = () => !busy() && !changed() && plan()?.problems.length === 0;
  return h(
    "form",
    { class: "panel", "aria-label": "Freeze", on: { submit: (event) => void submit(event) } },
    h("h2", {}, "Freeze"),
    h(
      "p",
      { class: "muted" },
      "From then on, any change to the plan is detected. The key holder, ideally someone who meets no participant, enters a passphrase: without it the labels cannot be opened, and it is not stored.",
    ),
    h("div", { class: "sts-fields" }, first.element, again.element),
    h("p", { class: "wrong", role: "alert" }, wrong),
    h(
      "div",
      { class: "row" },
      h("button", { type: "submit", class: "button main", disabled: () => !able() }, () =>
        busy() ? "Freezing …" : "Freeze the study",
      ),
    ),
  );
}

export function secret(
  id: string,
  label: string,
): { readonly element: HTMLElement; readonly input: HTMLInputElement } {
  const input = h("input", {
    id,
    type: "password",
    class: "sts-secret",
    autocomplete: "off",
    maxlength: 200,
  });
  return { element: h("span", { class: "field" }, h("label", { for: id }, label), input), input };
}
