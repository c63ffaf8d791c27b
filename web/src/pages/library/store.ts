/** What the library page knows: rows, the question and its answer, and the curves that are compared. */

import { keepComparison, workOn } from "../../app/current";
import { keepQuery, route } from "../../app/route";
import { call, live } from "../../net";
import type { LibraryButton, LibraryFound, LibraryStatus } from "../../net/messages";
import { batch, effect, onCleanup, type Signal, signal, tell, untracked } from "../../ui";
import { Rows } from "./rows";
import { AT_FIRST, asked, EVERYTHING, MOST, type Query, readState, type Shown, writeState } from "./state";

const KEEP_ms = 150;

const NOTHING: LibraryFound = {
  epoch: 0,
  positions: [],
  distances_jnd: [],
  jnds: "",
  histograms: {},
  kinds: {},
  origins: {},
  without: {},
  mended: [],
};

export class LibraryStore {
  readonly rows = new Rows();
  /** Counts what came into the rows. */
  readonly grown = signal(0);
  readonly standing: Signal<LibraryStatus | null> = signal(null);
  readonly query: Signal<Query> = signal(EVERYTHING);
  readonly shown: Signal<Shown> = signal(AT_FIRST);
  readonly found: Signal<LibraryFound> = signal(NOTHING);
  /** The question that found answers; another than query while the answer is on its way. */
  readonly answered: Signal<Query | null> = signal<Query | null>(null);
  /** Place in the list of found rows that the keys are at. */
  readonly active = signal(0);
  /** Buttons of the overlay whose curves are here, and the reasons of those that cannot be had. */
  readonly buttons: Signal<ReadonlyMap<string, LibraryButton>> = signal(new Map());
  readonly missing: Signal<ReadonlyMap<string, string>> = signal(new Map());
  /** The button whose menu is open, and what it hangs from. */
  readonly menu: Signal<{ readonly id: string; readonly anchor: HTMLElement } | null> = signal<{
    readonly id: string;
    readonly anchor: HTMLElement;
  } | null>(null);
  private loading = false;
  private again = false;
  private searching: AbortController | null = null;
  private readonly fetching = new Set<string>();

  constructor() {
    this.followAddress();
    this.keepAddress();
    effect(() => {
      this.query();
      this.grown();
      this.search();
    });
    effect(() => this.fetchCurves(this.shown().overlay));
    effect(() => {
      const { reference } = this.shown();
      if (reference) untracked(() => workOn(reference));
    });
    this.watch();
  }

  ask(change: Partial<Query>): void {
    batch(() => {
      this.query.update((query) => ({ ...query, ...change }));
      this.active.set(0);
    });
  }

  show(change: Partial<Shown>): void {
    this.shown.update((shown) => ({ ...shown, ...change }));
  }

  /** Take a button into the overlay, or out of it. */
  toggle(id: string): void {
    const { overlay, reference } = this.shown.peek();
    const next = overlay.includes(id) ? overlay.filter((one) => one !== id) : [...overlay, id].slice(0, MOST);
    this.show({
      overlay: next,
      reference: reference && next.includes(reference) ? reference : (next[0] ?? null),
    });
  }

  /** Return the id of the row that the keys are at. */
  activeId(): string | null {
    const at = this.found().positions[this.active()];
    return at === undefined ? null : (this.rows.ids[at] ?? null);
  }

  /** Return the name of a button; its id while the row is not here. */
  nameOf(id: string): string {
    return this.rows.names[this.rows.at(id)] ?? id;
  }

  /** Sort the list by how much its buttons feel like one. */
  findLike(id: string | null): void {
    if (id) this.ask({ like: id, text: "", sort: "match", descending: false });
  }

  rescan(): void {
    call("library.rescan", {}).catch(tell);
  }

  private followAddress(): void {
    effect(() => {
      const now = route();
      if (now.page !== "library") return;
      const state = readState(now.query);
      untracked(() =>
        batch(() => {
          this.query.set(state.query);
          this.shown.set(state.shown);
        }),
      );
    });
  }

  /** The address follows when hands rest: browsers refuse to change it with every letter. */
  private keepAddress(): void {
    let due: ReturnType<typeof setTimeout> | undefined;
    const keep = () => {
      clearTimeout(due);
      if (route.peek().page === "library") keepQuery(writeState(this.query.peek(), this.shown.peek()));
    };
    effect(() => {
      const state = writeState(this.query(), this.shown());
      untracked(() => keepComparison(state));
      clearTimeout(due);
      due = setTimeout(keep, KEEP_ms);
    });
    onCleanup(keep);
  }

  private watch(): void {
    const channel = live().channel("library", {
      onMessage: (standing) => {
        this.standing.set(standing);
        void this.load();
      },
      wrong: tell,
      opened: (channel) => void channel.send({ type: "watch" }),
    });
    onCleanup(() => channel.close());
    // what is known already need not wait for the live connection
    void this.load();
    this.rescan();
  }

  /** Fetch the rows that are new, one request at a time. */
  private async load(): Promise<void> {
    this.again = true;
    if (this.loading) return;
    this.loading = true;
    try {
      while (this.again) {
        this.again = false;
        const standing = this.standing.peek();
        const { epoch, length } = this.rows;
        if (standing && standing.epoch === epoch && standing.rows === length) continue;
        this.rows.take(await call("library.index", { epoch, first: length }));
        this.grown.update((n) => n + 1);
      }
    } catch (error) {
      tell(error);
    } finally {
      this.loading = false;
    }
  }

  private search(): void {
    this.searching?.abort();
    const mine = new AbortController();
    this.searching = mine;
    const query = this.query.peek();
    call("library.find", asked(query), mine.signal).then(
      (found) => {
        if (mine !== this.searching || found.epoch !== this.rows.epoch) return;
        batch(() => {
          this.found.set(found);
          this.answered.set(query);
        });
      },
      (error: unknown) => {
        if (!(error instanceof DOMException)) tell(error);
      },
    );
  }

  private fetchCurves(overlay: readonly string[]): void {
    const [here, gone] = [this.buttons.peek(), this.missing.peek()];
    const ids = overlay.filter((id) => !here.has(id) && !gone.has(id) && !this.fetching.has(id));
    if (!ids.length) return;
    ids.forEach((id) => this.fetching.add(id));
    call("library.curves", { ids })
      .then(({ buttons, missing }) =>
        batch(() => {
          this.buttons.update(
            (map) => new Map([...map, ...buttons.map((button) => [button.id, button] as const)]),
          );
          this.missing.update(
            (map) => new Map([...map, ...missing.map((one) => [one.id, one.reason] as const)]),
          );
        }),
      )
      .catch(tell)
      .finally(() => ids.forEach((id) => this.fetching.delete(id)));
  }
}
