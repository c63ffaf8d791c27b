/** All studies, and the form that declares one. */

import { address, go } from "../../app/route";
import { call } from "../../net";
import type { Offer, StudiesRow } from "../../net/messages";
import { choice, empty, h, onCleanup, signal, tell } from "../../ui";
import { watchStudies } from "./store";

export function studyList(host: HTMLElement): void {
  const rows = signal<readonly StudiesRow[] | null>(null);
  let gone = false;
  onCleanup(() => (gone = true));
  const refresh = () => void call("studies.list", {}).then((found) => !gone && rows.set(found.rows), tell);
  watchStudies(refresh);
  refresh();
  host.append(
    h("h1", { class: "visually-hidden" }, "Studies"),
    h(
      "div",
      { class: "sts-start" },
      newStudy(),
      h("section", { class: "panel", "aria-label": "Studies" }, h("h2", {}, "Studies"), () => listed(rows())),
    ),
  );
}

function listed(rows: readonly StudiesRow[] | null): HTMLElement {
  if (!rows) return h("p", { class: "muted" }, "…");
  if (!rows.length)
    return empty(
      "No studies yet",
      "Start from the closest template: you can change every field until you freeze it.",
    );
  return h("ul", { class: "sts-list" }, rows.map(item));
}

function item(row: StudiesRow): HTMLElement {
  const said = row.problem
    ? h("span", { class: "wrong" }, row.problem)
    : h("span", { class: "muted" }, `${row.kind}, ${row.people} of ${row.planned} people`);
  return h(
    "li",
    {},
    h(
      "a",
      { class: "sts-item", href: address("studies", row.name) },
      h("span", { class: "row spread" }, h("strong", {}, row.title || row.name), stateTag(row.state)),
      said,
    ),
  );
}

export function stateTag(state: StudiesRow["state"]): HTMLElement {
  return h("span", { class: `tag sts-${state}` }, state);
}

function newStudy(): HTMLElement {
  const offers = signal<readonly Offer[]>([]);
  const template = signal("");
  const busy = signal(false);
  let gone = false;
  onCleanup(() => (gone = true));
  const offered = (found: readonly Offer[]) => {
    template.set(found.find((one) => one.name === "realism")?.name ?? found[0]?.name ?? "");
    offers.set(found);
  };
  call("studies.offers", {}).then((found) => !gone && offered(found.templates), tell);
  const name = h("input", {
    id: "sts-name",
    type: "text",
    maxlength: 40,
    autocomplete: "off",
    spellcheck: "false",
    placeholder: "my-study",
  });
  const declare = async () => {
    busy.set(true);
    try {
      const made = await call("studies.create", { name: name.value.trim(), template: template.peek() });
      go("studies", made.study);
    } catch (error) {
      tell(error);
    } finally {
      busy.set(false);
    }
  };
  const submit = (event: Event) => {
    event.preventDefault();
    void declare();
  };
  return h(
    "form",
    { class: "panel sts-new", "aria-label": "New study", on: { submit } },
    h("h2", {}, "New study"),
    h(
      "p",
      { class: "muted" },
      "Two blinded renderings, a reference button, and participants who do not know which is which. Nor do you, until you unseal the study.",
    ),
    h("span", { class: "field" }, h("label", { for: "sts-name" }, "Name"), name),
    () =>
      offers().length
        ? choice({
            label: "Kind",
            options: offers().map((offer) => [offer.name, `${offer.name}: ${offer.told}`] as const),
            value: template,
            set: template.set,
          })
        : null,
    h(
      "div",
      { class: "row" },
      h(
        "button",
        { type: "submit", class: "button main", disabled: () => busy() || !offers().length },
        "Create",
      ),
    ),
  );
}
