/** Files that cannot be used, each with its reason; and a look for files that came or went. */

import { call } from "../../net";
import type { LibraryRefusal } from "../../net/messages";
import { button, effect, h, signal, tell } from "../../ui";
import type { LibraryStore } from "./store";

export function refusedFiles(store: LibraryStore): HTMLElement {
  const open = signal(false);
  const files = signal<readonly LibraryRefusal[]>([]);
  const count = () => store.standing()?.refused ?? 0;
  effect(() => {
    if (open() && count() > 0) call("library.refused", {}).then((found) => files.set(found.files), tell);
  });
  const details = h(
    "details",
    { class: "lib-refused", hidden: () => count() === 0, on: { toggle: () => open.set(details.open) } },
    h("summary", {}, () => `${count()} files cannot be used`),
    h("ul", { tabindex: 0, "aria-label": "Files that cannot be used" }, () =>
      files().map((file) =>
        h("li", {}, h("strong", {}, file.place), h("span", { class: "muted" }, ` ${file.reason}`)),
      ),
    ),
  );
  return h(
    "div",
    { class: "lib-foot" },
    details,
    h("span", { class: "grow" }),
    button({
      label: "Rescan",
      kind: "quiet",
      hint: "Look for new, changed and removed files",
      act: () => store.rescan(),
    }),
  );
}
