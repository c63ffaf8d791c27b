/** What a page is: a module that fills its host element, and is undone with the scope it is mounted in. */

import type { Route } from "./route";

export interface Page {
  /** Of the browser's tab and the page's heading. */
  readonly title: string;
  /** Fill the host; runs in a scope, so effects and cleanups end when the page goes. */
  mount(host: HTMLElement, route: Route): void;
  /** Whether the page itself follows another id or query; else it is mounted anew. */
  readonly followsRoute?: boolean;
}

export interface Entry {
  readonly name: string;
  readonly label: string;
  /** Said under the label's place where there is room. */
  readonly hint: string;
  /** Reached by its address only, with nothing of the studio around it: no navigation, no keys that lead away. */
  readonly alone?: boolean;
  /** Whether another package brings its part of the server. */
  readonly extra?: boolean;
  readonly load: () => Promise<{ readonly page: Page }>;
}
