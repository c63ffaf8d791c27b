/** Fingerprint, checks, and the act that tells what the labels hid; then the report. */

import { download } from "../../draw";
import { call } from "../../net";
import { button, type Child, empty, h, signal, tell } from "../../ui";
import { secret } from "./plan";
import type { StudyStore } from "./store";

export function sealView(store: StudyStore): HTMLElement {
  const state = store.detail.peek()?.row.state ?? "draft";
  if (state === "draft") return empty("Not frozen yet", "Freeze the study first.");
  return h(
    "div",
    { class: "sts-two" },
    h("div", { class: "sts-page" }, fingerprint(store), history(store)),
    h("div", { class: "sts-page" }, state === "unsealed" ? results(store) : null, unsealing(store)),
  );
}

function fingerprint(store: StudyStore): HTMLElement {
  const found = signal<readonly string[] | null>(null);
  const verify = () =>
    void call("studies.verify", { study: store.study }).then((answer) => found.set(answer.problems), tell);
  return h(
    "section",
    { class: "panel", "aria-label": "Fingerprint" },
    h("h2", {}, "Fingerprint"),
    h("p", { class: "sts-print", "data-fingerprint": "" }, () => store.detail()?.fingerprint ?? ""),
    h(
      "p",
      { class: "muted" },
      () => `Frozen ${store.detail()?.frozen ?? ""}. Put it in the preregistration: it identifies this plan.`,
    ),
    () => codeAlone(store.detail()?.code_alone ?? []),
    h("div", { class: "row" }, button({ label: "Verify", act: verify, hint: "Check for changes since" })),
    h("div", { role: "status" }, () => verified(found())),
  );
}

/** People whom an earlier fdvv enrolled. */
function codeAlone(people: readonly string[]): Child {
  if (!people.length) return null;
  return h(
    "p",
    { class: "muted" },
    `The code alone of ${people.join(", ")} opens what their labels hide, for an earlier fdvv enrolled them: keep their cards away.`,
  );
}

function verified(problems: readonly string[] | null): Child {
  if (!problems) return null;
  if (!problems.length) return h("p", { class: "sts-good" }, "Nothing has changed.");
  return h(
    "ul",
    { class: "sts-problems" },
    problems.map((line) => h("li", {}, line)),
  );
}

function history(store: StudyStore): HTMLElement {
  return h("section", { class: "panel", "aria-label": "Record" }, h("h2", {}, "Record"), () =>
    h(
      "ol",
      { class: "sts-history" },
      (store.detail()?.history ?? []).map((line) => h("li", {}, line)),
    ),
  );
}

function unsealing(store: StudyStore): HTMLElement {
  const pass = secret("sts-open", "Passphrase of the key holder");
  const who = textField("sts-who", "Who unseals");
  const why = textField("sts-why", "Why now");
  const [busy, said] = [signal(false), signal("")];
  const again = store.detail.peek()?.row.state === "unsealed";
  const submit = async (event: Event) => {
    event.preventDefault();
    busy.set(true);
    try {
      const found = await call("studies.unseal", {
        study: store.study,
        passphrase: pass.input.value,
        who: who.input.value.trim(),
        why: why.input.value.trim(),
      });
      said.set(`${found.rows} trials, ${found.excluded} of them excluded by rule, are in ${found.folder}.`);
      await store.refresh();
    } catch (error) {
      tell(error);
    } finally {
      busy.set(false);
    }
  };
  return h(
    "form",
    { class: "panel", "aria-label": "Unseal", on: { submit: (event) => void submit(event) } },
    h("h2", {}, again ? "Unseal again" : "Unseal"),
    h(
      "p",
      { class: "muted" },
      again
        ? "Answers given since are opened too; this is recorded as well."
        : "Only after the last participant: nobody can take part afterwards. Who unsealed it, and why, is recorded permanently.",
    ),
    h("div", { class: "sts-fields" }, who.element, why.element, pass.element),
    h(
      "div",
      { class: "row" },
      h("button", { type: "submit", class: "button", disabled: busy }, () =>
        busy() ? "Opening …" : "Unseal permanently",
      ),
    ),
    h("p", { role: "status" }, said),
  );
}

function results(store: StudyStore): HTMLElement {
  const busy = signal(false);
  const report = async () => {
    busy.set(true);
    try {
      const made = await call("studies.report", { study: store.study });
      download(made.name, made.html, "text/html");
    } catch (error) {
      tell(error);
    } finally {
      busy.set(false);
    }
  };
  return h(
    "section",
    { class: "panel", "aria-label": "Results" },
    h("h2", {}, "Results"),
    h(
      "p",
      { class: "muted" },
      "The study is open. Its folder holds the answers and the code book as CSV and JSON, for R, JASP or pandas.",
    ),
    h(
      "div",
      { class: "row" },
      button({ label: "Save the report", kind: "main", act: () => void report(), disabled: busy }),
      h("span", { class: "muted" }, () => (busy() ? "Writing the report …" : "")),
    ),
  );
}

function textField(
  id: string,
  label: string,
): { readonly element: HTMLElement; readonly input: HTMLInputElement } {
  const input = h("input", { id, type: "text", autocomplete: "off", maxlength: 300 });
  return { element: h("span", { class: "field" }, h("label", { for: id }, label), input), input };
}
