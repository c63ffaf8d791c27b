/** Who is in the overlay: name, speed, what the curves say under the pointer; choose the reference, take out. */

import type { LibraryButton } from "../../net/messages";
import { button, computed, h } from "../../ui";
import { figure, speedText } from "./columns";
import { valueAt } from "./curves";
import { DISTINCT, swatch } from "./marks";
import { AXES, type Drawn, type Overlay } from "./overlay";
import type { LibraryStore } from "./store";

export function legend(store: LibraryStore, overlay: Overlay): HTMLElement {
  // made anew only when other buttons are compared, so that the focus stays where it is
  const ids = computed(() => JSON.stringify(store.shown().overlay));
  return h("div", { class: "lib-legend-place" }, () => {
    const all = JSON.parse(ids()) as string[];
    return h(
      "ul",
      { class: "lib-legend", "aria-label": "Compared buttons", hidden: !all.length },
      all.map((id, n) => entry(store, overlay, id, n)),
    );
  });
}

function entry(store: LibraryStore, overlay: Overlay, id: string, n: number): HTMLElement {
  const found = () => store.buttons().get(id);
  const name = () => found()?.name ?? store.rows.names[store.rows.at(id)] ?? id;
  const reference = () => store.shown().reference === id;
  return h(
    "li",
    { class: () => `lib-chip${reference() ? " reference" : ""}` },
    n < DISTINCT ? swatch(n) : h("span", { class: "muted" }, "dimmed"),
    h(
      "span",
      { class: "lib-chip-words", title: () => name() },
      h("span", { class: "lib-chip-name" }, () => name()),
      h("span", { class: "muted" }, () => said(store, overlay, found(), id)),
    ),
    button({
      label: `Use ${name()} as the reference`,
      glyph: "Δ",
      kind: "quiet",
      pressed: reference,
      hint: "Reference for the differences",
      act: () => store.show({ reference: id }),
    }),
    button({
      label: `Remove ${name()}`,
      glyph: "×",
      kind: "quiet",
      hint: "Remove",
      act: () => store.toggle(id),
    }),
  );
}

function said(store: LibraryStore, overlay: Overlay, found: LibraryButton | undefined, id: string): string {
  if (!found) return store.missing().get(id) ?? "reading …";
  const drawn = overlay.drawn().filter((one) => one.button === found);
  const at = overlay.cursor_mm();
  if (at !== null) return `${values(store, drawn, at)} at ${figure(at, 2)} mm`;
  const speed = speedText((drawn.find((one) => one.stroke === "press") ?? drawn[0])?.velocity_mm_s);
  return found.simulated ? `simulated, ${speed}` : speed;
}

function values(store: LibraryStore, drawn: readonly Drawn[], at_mm: number): string {
  const unit = AXES[store.shown().view].unit;
  const text = (stroke: string) => {
    const one = drawn.find((other) => other.stroke === stroke);
    return one ? figure(valueAt(one.line, at_mm), store.shown().view === "work" ? 2 : 1) : "";
  };
  return `${[text("press"), text("release")].filter(Boolean).join(" / ")} ${unit}`;
}
