/** Which page is shown. */

import { type Cleanup, effect, scope } from "../ui/signal.svelte";
import { dismissNotices, tell } from "../ui/toast";
import { PAGES } from "./pages";
import { address, type Route, route } from "./route";
import type { Entry, Page } from "./types";

/** Mount the page of the route, and take it away when the route leads elsewhere. */
export function showPages(host: HTMLElement): void {
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
      dismissNotices(shown?.entry !== entry);
      leave();
      host.replaceChildren();
      host.dataset.page = entry.name;
      document.title = `${page.title} · fdvv studio`;
      shown = { entry, page, key };
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
    else location.replace(address("home"));
  });
}
