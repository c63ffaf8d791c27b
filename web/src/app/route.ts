/** Where the page is, kept in the address: `#/edit/own:my-button?overlay=a,b`. */

import { type Signal, signal } from "../ui/signal.svelte";

export interface Route {
  readonly page: string;
  /** Of a button, program or job; empty where the page stands for itself. */
  readonly id: string;
  readonly query: URLSearchParams;
}

export function parseRoute(hash: string): Route {
  const [path = "", query = ""] = hash.replace(/^#\/?/, "").split("?", 2);
  const slash = path.indexOf("/");
  const page = slash < 0 ? path : path.slice(0, slash);
  const id = slash < 0 ? "" : decode(path.slice(slash + 1));
  return { page, id, query: new URLSearchParams(query) };
}

function decode(text: string): string {
  try {
    return decodeURIComponent(text);
  } catch {
    return text;
  }
}

/** Write an address as parseRoute reads it. */
export function address(page: string, id = "", query?: URLSearchParams | Record<string, string>): string {
  const asked = new URLSearchParams(query).toString();
  return `#/${page}${id ? `/${encodeURIComponent(id)}` : ""}${asked ? `?${asked}` : ""}`;
}

/** The route of now. */
export const route: Signal<Route> = signal<Route>({ page: "", id: "", query: new URLSearchParams() });

export function go(page: string, id = "", query?: URLSearchParams | Record<string, string>): void {
  location.hash = address(page, id, query);
}

/** The address as it was last read or written here: another one is a step of the person's that is not read yet. */
let known = "";

/** Keep the state of a page's view in the address, without a step in the browser's history.
 *
 * Nothing is written while a new address waits for its `hashchange`, which browsers send later as a task of its own:
 * it would be overwritten, and the person would stay where they are. */
export function keepQuery(query: URLSearchParams | Record<string, string>): void {
  if (location.hash !== known) return;
  const { page, id } = route.peek();
  const next = address(page, id, query);
  if (next === known) return;
  history.replaceState(null, "", next);
  known = location.hash;
}

export function followAddress(): void {
  const read = () => {
    known = location.hash;
    route.set(parseRoute(known));
  };
  addEventListener("hashchange", read);
  read();
}
