/** All that is known of the button that the keys are at. */

import { call } from "../../net";
import type { LibraryButton } from "../../net/messages";
import { button, type Child, effect, h, signal, tell } from "../../ui";
import { actions } from "./actions";
import type { LibraryStore } from "./store";

export function about(store: LibraryStore): HTMLElement {
  const found = signal<LibraryButton | null>(null);
  effect(() => {
    const id = store.shown().tab === "about" ? store.activeId() : null;
    if (id === null) return;
    const stop = new AbortController();
    call("library.curves", { ids: [id] }, stop.signal).then(
      ({ buttons, missing }) => {
        found.set(buttons[0] ?? null);
        for (const one of missing) tell(new Error(one.reason));
      },
      (error: unknown) => (error instanceof DOMException ? undefined : tell(error)),
    );
    return () => stop.abort();
  });
  return h(
    "div",
    { class: "lib-scroll lib-about-panel", tabindex: 0, role: "region", "aria-label": "About this button" },
    () => {
      const now = found();
      return now ? facts(store, now) : h("p", { class: "muted lib-hint" }, "Choose a button in the list.");
    },
  );
}

function facts(store: LibraryStore, now: LibraryButton): Child {
  const inside = () => store.shown().overlay.includes(now.id);
  const rows: [string, string][] = [
    ["Type, by its force", `${now.kind}: ${now.kind_reason}`],
    ["Stated in its name or folder", now.stated.join(", ") || "nothing"],
    ["Source", [now.source, now.collection].filter(Boolean).join("; ") || "not stated"],
    ["Licence", now.licence || "not stated in the file"],
    ["Presses", now.cycles === null ? "not stated" : `mean of ${now.used} of ${now.cycles} in the file`],
    ["File of", now.date ?? "shipped with fdvv"],
    ...now.why.map(
      (line) => [line.slice(0, line.indexOf(":")), line.slice(line.indexOf(":") + 2)] as [string, string],
    ),
  ];
  return [
    h(
      "div",
      { class: "row spread" },
      h("h3", {}, now.name, now.simulated ? h("span", { class: "tag simulated" }, "simulated") : null),
    ),
    h(
      "div",
      { class: "row lib-actions", "data-id": now.id },
      actions(store, now.id),
      button({ label: "Compare", pressed: inside, act: () => store.toggle(now.id) }),
    ),
    h(
      "dl",
      { class: "lib-facts" },
      rows.map(([term, text]) => [h("dt", {}, term), h("dd", {}, text)]),
    ),
  ];
}
