/** Which page is shown. */

import { mount, unmount } from "svelte";
import Empty from "../ui/Empty.svelte";
import { type Cleanup, effect, onCleanup, scope } from "../ui/signal.svelte";
import { dismissNotices, tell } from "../ui/toast";
import { askAbsent, packageOf } from "./absent";
import { PAGES } from "./pages";
import { address, type Route, route } from "./route";
import type { Entry, Page } from "./types";

function absentPage({ label }: Entry, name: string): Page {
  return {
    title: label,
    mount(target) {
      const title = `${label} is not installed`;
      const text = `It comes with ${name}: pip install ${name}, then start the studio again.`;
      const made = mount(Empty, { target, props: { title, text } });
      onCleanup(() => void unmount(made));
    },
  };
}

async function pageOf(entry: Entry): Promise<Page> {
  if (entry.extra) await askAbsent();
  const name = packageOf(entry.name);
  return name ? absentPage(entry, name) : (await entry.load()).page;
}

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
      const page = await pageOf(entry);
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
