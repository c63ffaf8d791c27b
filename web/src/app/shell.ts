/** The frame around every page: navigation, theme, connection, keys. */

import { type LiveState, live } from "../net/live";
import {
  addShortcuts,
  button,
  type Cleanup,
  effect,
  h,
  scope,
  shortcuts,
  signal,
  tell,
  untracked,
} from "../ui";
import { headerExtras } from "./header";
import { LISTED, PAGES } from "./pages";
import { address, go, type Route, route } from "./route";
import { nextTheme, theme } from "./theme";
import type { Entry, Page } from "./types";

const THEMES = { system: "Theme: system", light: "Theme: light", dark: "Theme: dark" } as const;
const SAID: Readonly<Record<LiveState, string>> = {
  opening: "connecting",
  open: "",
  lost: "connection lost; reconnecting",
};

/** Whether the help sheet is shown. */
const helping = signal(false);

/** Whether the page stands alone, with nothing of the studio around it. */
const alone = (): boolean => !!PAGES.find((entry) => entry.name === route().page)?.alone;

export function mountShell(body: HTMLElement): void {
  const host = h("main", { id: "page", tabindex: "-1" });
  body.append(skipLink(host), header(), banner(), host, helpSheet());
  addShortcuts(
    { keys: "?", does: "Show or hide this list", act: () => untracked(alone) || helping.update((on) => !on) },
    ...LISTED.map((entry, at) => ({
      keys: `Alt+${at + 1}`,
      does: `Go to ${entry.label}`,
      act: () => untracked(alone) || go(entry.name),
      always: true,
    })),
  );
  showPages(host);
}

function skipLink(host: HTMLElement): HTMLElement {
  const click = (event: Event) => {
    event.preventDefault();
    host.focus();
  };
  return h("a", { class: "skip", href: "#page", hidden: alone, on: { click } }, "Skip to the page");
}

function header(): HTMLElement {
  return h(
    "header",
    { class: "top", hidden: alone },
    h("a", { class: "brand", href: address("library") }, "fdvv studio"),
    h(
      "nav",
      { "aria-label": "Pages" },
      LISTED.map((entry) =>
        h(
          "a",
          {
            href: address(entry.name),
            title: entry.hint,
            "aria-current": () => (route().page === entry.name ? "page" : null),
          },
          entry.label,
        ),
      ),
    ),
    h("span", { class: "grow" }),
    h("span", { class: "row" }, () => headerExtras()),
    button({
      label: "Keys",
      glyph: "?",
      kind: "quiet",
      act: () => helping.update((on) => !on),
      hint: "Keys (?)",
    }),
    h(
      "button",
      {
        type: "button",
        class: "button quiet",
        "aria-label": () => `${THEMES[theme()]}; change`,
        on: { click: nextTheme },
      },
      () => ({ system: "◐", light: "☀", dark: "☾" })[theme()],
    ),
  );
}

function banner(): HTMLElement {
  const line = () => SAID[live().state()];
  const lost = () => live().state() === "lost" && !alone();
  return h("div", { class: () => `banner${lost() ? " shown" : ""}`, role: "status" }, line);
}

function helpSheet(): HTMLElement {
  const close = button({ label: "Close", kind: "quiet", act: () => helping.set(false) });
  const rows = () =>
    shortcuts().map((shortcut) =>
      h("div", { class: "key-row" }, h("dt", {}, h("kbd", {}, shortcut.keys)), h("dd", {}, shortcut.does)),
    );
  const sheet = h(
    "aside",
    { class: "help", "aria-label": "Keys", hidden: () => !helping() },
    h("div", { class: "row spread" }, h("h2", {}, "Keys"), close),
    h("dl", {}, rows),
  );
  sheet.addEventListener("keydown", (event) => {
    if (event.key === "Escape") helping.set(false);
  });
  return sheet;
}

/** Mount the page of the route, and take it away when the route leads elsewhere. */
function showPages(host: HTMLElement): void {
  let leave: Cleanup = () => undefined;
  let shown: { readonly entry: Entry; readonly page: Page; readonly key: string } | null = null;
  let turn = 0;

  const show = async (entry: Entry, now: Route) => {
    const mine = ++turn;
    const key = now.id;
    if (shown?.entry === entry && (shown.page.followsRoute || shown.key === key)) return;
    try {
      const { page } = await entry.load();
      if (mine !== turn) return;
      leave();
      host.replaceChildren();
      host.dataset.page = entry.name;
      document.title = `${page.title} · fdvv studio`;
      shown = { entry, page, key };
      if (entry.alone) helping.set(false);
      leave = scope(() => page.mount(host, now));
      document.documentElement.dataset.ready = entry.name;
    } catch (error) {
      tell(error);
    }
  };

  effect(() => {
    const now = route();
    const entry = PAGES.find((one) => one.name === now.page);
    if (entry) void show(entry, now);
    else location.replace(address("library"));
  });
}
