/** Landmarks side by side, with their differences to the reference. */

import type { LibraryButton } from "../../net/messages";
import { h } from "../../ui";
import { COLUMNS, type Column, figure, speedText, whyNot } from "./columns";
import { strokeAt } from "./curves";
import { DISTINCT, swatch } from "./marks";
import type { LibraryStore } from "./store";

export function landmarkTable(store: LibraryStore): HTMLElement {
  const chosen = () =>
    store.shown().overlay.flatMap((id, n) => {
      const button = store.buttons().get(id);
      return button ? [{ button, n }] : [];
    });
  const reference = () => store.buttons().get(store.shown().reference ?? "");
  return h(
    "div",
    { class: "lib-scroll", tabindex: 0, role: "region", "aria-label": "Landmarks of the compared buttons" },
    () => {
      const all = chosen();
      if (!all.length)
        return h(
          "p",
          { class: "muted lib-hint" },
          "Choose buttons with Space, or a click on their box, to compare their landmarks.",
        );
      return h(
        "table",
        { class: "lib-landmarks" },
        h(
          "thead",
          {},
          h(
            "tr",
            {},
            h("th", { scope: "col" }, "Landmark"),
            all.map(({ button, n }) => head(button, n, button === reference())),
          ),
        ),
        h(
          "tbody",
          {},
          h(
            "tr",
            {},
            h("th", { scope: "row" }, "Type"),
            all.map(({ button }) => h("td", { title: button.kind_reason }, button.kind)),
          ),
          h(
            "tr",
            {},
            h("th", { scope: "row" }, "Speed"),
            all.map(({ button }) => h("td", { class: "number" }, pressSpeed(store, button))),
          ),
          COLUMNS.map((column) =>
            row(
              column,
              all.map((one) => one.button),
              reference(),
            ),
          ),
        ),
      );
    },
  );
}

function pressSpeed(store: LibraryStore, button: LibraryButton): string {
  return speedText(strokeAt(button, "press", store.shown().velocity_mm_s)?.velocity_mm_s);
}

function head(button: LibraryButton, n: number, isReference: boolean): HTMLElement {
  return h(
    "th",
    { scope: "col", class: "lib-head" },
    n < DISTINCT ? swatch(n) : null,
    h("span", { class: "lib-head-name", title: button.name }, button.name),
    isReference ? h("span", { class: "tag" }, "reference") : null,
  );
}

function row(
  column: Column,
  buttons: readonly LibraryButton[],
  reference: LibraryButton | undefined,
): HTMLElement {
  const unit = column.unit ? `, ${column.unit}` : "";
  return h(
    "tr",
    {},
    h("th", { scope: "row", title: column.label }, `${column.short}${unit}`),
    buttons.map((button) => cell(column, button, reference)),
  );
}

function cell(column: Column, button: LibraryButton, reference: LibraryButton | undefined): HTMLElement {
  const value = button.numbers[column.name] ?? null;
  if (value === null) {
    const why = whyNot(button.why, column);
    return h("td", { class: "number muted", title: why }, "–", h("span", { class: "visually-hidden" }, why));
  }
  const base = reference?.numbers[column.name] ?? null;
  const off = base === null || button === reference ? null : value - base;
  return h(
    "td",
    { class: "number" },
    figure(value, column.digits),
    off === null
      ? null
      : h("span", { class: "lib-off" }, ` ${off >= 0 ? "+" : ""}${figure(off, column.digits)}`),
  );
}
