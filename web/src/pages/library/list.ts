/** The list of buttons: only the rows in sight are made, and they are used again as it scrolls. */

import { palette } from "../../draw";
import { effect, h, onCleanup, unitText } from "../../ui";
import { columnOf, figure, LISTED } from "./columns";
import type { LibraryStore } from "./store";
import { drawThumbnail, SIZE_px } from "./thumbnail";

const ROW_px = 56;
const AHEAD = 4;

interface RowView {
  readonly element: HTMLElement;
  readonly canvas: HTMLCanvasElement;
  readonly pin: HTMLElement;
  readonly name: HTMLElement;
  readonly about: HTMLElement;
  readonly figures: readonly HTMLElement[];
  readonly menu: HTMLElement;
  /** Position in the index that is drawn, and the growth of the index it was drawn at. */
  drawn: string;
  place: number;
}

/** Names of the columns that rows show now: the usual ones, and what is sorted by. */
export function listedColumns(sort: string): readonly string[] {
  return columnOf(sort) && !(LISTED as readonly string[]).includes(sort)
    ? [...LISTED.slice(0, 3), sort]
    : LISTED;
}

export class ButtonList {
  readonly element: HTMLElement;
  private readonly inner = h("div", { class: "lib-inner", role: "rowgroup" });
  private readonly views: RowView[] = [];
  private frame = 0;

  constructor(
    private readonly store: LibraryStore,
    private readonly open: (id: string) => void,
  ) {
    this.element = h(
      "div",
      {
        class: "lib-list",
        role: "grid",
        tabindex: 0,
        "aria-label": "Buttons",
        "aria-multiselectable": "true",
        on: { keydown: (event) => this.onKey(event), scroll: () => this.request() },
      },
      this.inner,
    );
    const observer = new ResizeObserver(() => this.request());
    observer.observe(this.element);
    onCleanup(() => {
      observer.disconnect();
      cancelAnimationFrame(this.frame);
    });
    effect(() => {
      const [found] = [
        store.found(),
        store.answered(),
        store.grown(),
        store.shown(),
        palette(),
        store.active(),
      ];
      this.inner.style.height = `${found.positions.length * ROW_px}px`;
      this.element.ariaRowCount = String(found.positions.length);
      this.request();
    });
    effect(() => {
      store.query();
      this.element.ariaBusy = "true";
    });
  }

  /** Move the row that the keys are at, and bring it into sight. */
  move(to: number): void {
    const count = this.store.found.peek().positions.length;
    if (!count) return;
    const at = Math.min(Math.max(to, 0), count - 1);
    this.store.active.set(at);
    const [top, height] = [this.element.scrollTop, this.element.clientHeight];
    if (at * ROW_px < top) this.element.scrollTop = at * ROW_px;
    else if ((at + 1) * ROW_px > top + height) this.element.scrollTop = (at + 1) * ROW_px - height;
  }

  onKey(event: KeyboardEvent): void {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const now = this.store.active.peek();
    const page = Math.max(1, Math.floor(this.element.clientHeight / ROW_px) - 1);
    const moves: Record<string, number> = {
      ArrowDown: now + 1,
      ArrowUp: now - 1,
      PageDown: now + page,
      PageUp: now - page,
      Home: 0,
      End: this.store.found.peek().positions.length - 1,
    };
    const id = this.store.activeId();
    if (moves[event.key] !== undefined) this.move(moves[event.key] as number);
    else if (event.key === " " && id) this.store.toggle(id);
    else if (event.key === "Enter" && id) this.open(id);
    else if (["m", "ContextMenu"].includes(event.key) && id) this.openMenu(id);
    else return;
    event.preventDefault();
  }

  /** Open the menu of the row that the keys are at. */
  private openMenu(id: string): void {
    const row = this.views.find(({ place }) => place === this.store.active.peek());
    if (row) this.store.menu.set({ id, anchor: row.menu });
  }

  private request(): void {
    this.frame ||= requestAnimationFrame(() => {
      this.frame = 0;
      this.paint();
    });
  }

  /** Put the rows in sight in their places; a row that is there already is only moved. */
  private paint(): void {
    const count = this.store.found.peek().positions.length;
    const settled = this.store.answered.peek() === this.store.query.peek();
    // the rows of another question begin at the top; moved only now, for that costs a layout
    if (settled && this.element.ariaBusy === "true") this.element.scrollTop = 0;
    const first = Math.max(0, Math.floor(this.element.scrollTop / ROW_px) - AHEAD);
    const last = Math.min(
      count,
      Math.ceil((this.element.scrollTop + this.element.clientHeight) / ROW_px) + AHEAD,
    );
    while (this.views.length < last - first) this.views.push(this.make());
    const size = this.views.length;
    for (const [slot, view] of this.views.entries()) {
      // slot s always serves the places that are s modulo the number of slots
      const place = first + ((((slot - first) % size) + size) % size);
      view.element.hidden = place >= last;
      if (place < last) this.fill(view, place);
    }
    if (settled) this.element.ariaBusy = "false";
    const active = this.views.find((view) => !view.element.hidden && view.place === this.store.active.peek());
    if (active) this.element.setAttribute("aria-activedescendant", active.element.id);
    else this.element.removeAttribute("aria-activedescendant");
  }

  private make(): RowView {
    const canvas = h("canvas", { class: "lib-thumb", "aria-hidden": "true" });
    canvas.style.width = `${SIZE_px.width}px`;
    canvas.style.height = `${SIZE_px.height}px`;
    const pin = h("span", { class: "lib-check", "aria-hidden": "true" });
    const [name, about] = [h("span", { class: "lib-name" }), h("span", { class: "lib-about" })];
    const figures = LISTED.map(() => h("span", { class: "lib-figure", role: "gridcell" }));
    const menu = h(
      "button",
      { type: "button", class: "button quiet", tabindex: -1, title: "Actions (M)" },
      "⋯",
    );
    const element = h(
      "div",
      { class: "lib-row", role: "row", id: `lib-row-${this.views.length}` },
      h("span", { class: "lib-pin", role: "gridcell", title: "Compare (Space)" }, pin),
      canvas,
      h("span", { class: "lib-words", role: "gridcell" }, name, about),
      figures,
      h("span", { class: "lib-menu", role: "gridcell" }, menu),
    );
    const view: RowView = { element, canvas, pin, name, about, figures, menu, drawn: "", place: -1 };
    element.addEventListener("click", (event) => this.onClick(view, event));
    element.addEventListener("dblclick", () => {
      const id = this.store.activeId();
      if (id) this.open(id);
    });
    this.inner.append(element);
    return view;
  }

  private onClick(view: RowView, event: MouseEvent): void {
    this.store.active.set(view.place);
    const id = this.store.activeId();
    const on = event.target as HTMLElement;
    if (id && on.closest(".lib-menu")) return this.store.menu.set({ id, anchor: view.menu });
    if (id && on.closest(".lib-pin")) this.store.toggle(id);
    this.element.focus({ preventScroll: true });
    this.request();
  }

  private fill(view: RowView, place: number): void {
    const { rows, found, query, shown, active } = this.store;
    const at = found.peek().positions[place] as number;
    const id = rows.ids[at];
    if (id === undefined) {
      view.element.hidden = true;
      return;
    }
    if (view.place !== place) {
      view.place = place;
      view.element.style.transform = `translateY(${place * ROW_px}px)`;
      view.element.ariaRowIndex = String(place + 1);
    }
    const pinned = shown.peek().overlay.includes(id);
    view.element.ariaSelected = String(pinned);
    view.element.classList.toggle("pinned", pinned);
    view.element.classList.toggle("active", place === active.peek());
    const like = query.peek().like === null ? null : (found.peek().distances_jnd[place] ?? null);
    const columns = listedColumns(query.peek().sort);
    const drawn = [id, rows.epoch, like, columns.at(-1), palette().accent].join("|");
    if (view.drawn === drawn) return;
    view.drawn = drawn;
    this.write(view, at, columns, like);
    drawThumbnail(view.canvas, rows, at);
  }

  private write(view: RowView, at: number, columns: readonly string[], like: number | null): void {
    const { rows } = this.store;
    view.name.textContent = rows.names[at] ?? "";
    view.name.title = rows.names[at] ?? "";
    view.menu.ariaLabel = `Actions for ${rows.names[at] ?? ""}`;
    const kind = rows.kinds[at] as string;
    const words = [kind, rows.simulated[at] ? "simulated" : "", rows.collections[at] || rows.origins[at]];
    view.about.textContent = (like === null ? words : [`${like.toFixed(1)} JND away`, ...words])
      .filter(Boolean)
      .join(" · ");
    view.about.title = view.about.textContent;
    view.figures.forEach((element, i) => {
      const column = columnOf(columns[i] as string);
      const value = column ? rows.number(column.name, at) : null;
      element.textContent = figure(value, column?.digits ?? 1, column?.unit);
      element.title = column
        ? `${column.label}${value === null ? ": not detected" : `, ${unitText(column.unit)}`}`
        : "";
      element.ariaLabel = column
        ? `${column.short} ${value === null ? "not known" : `${element.textContent} ${unitText(column.unit)}`}`
        : "";
    });
  }
}
