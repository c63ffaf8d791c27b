/** The control points of the active curve as a grid: exact numbers, typed; walked by keys as a spreadsheet. */

import { controlPoints_mm } from "../../math";
import { addPoint, setPoints } from "../../model";
import { walked } from "../../tools/grid";
import { toggled } from "../../tools/selection";
import { typed } from "../../tools/typed";
import { batch, button, computed, effect, h, shown, toast, untracked } from "../../ui";
import { type EditorController, refOf } from "./editor_controller";
import { removeSelected } from "./point_edits";

const COLUMNS = ["#", "displacement, mm", "force, cN"] as const;
const FORCE = 2;

/** The table and the buttons that change how many points there are. */
export function pointsTable(editor: EditorController): HTMLElement {
  const body = h("tbody", {});
  const grid = h(
    "table",
    { class: "edit-points", role: "grid", "aria-label": "Control points", "aria-multiselectable": "true" },
    h(
      "thead",
      {},
      h(
        "tr",
        {},
        COLUMNS.map((name) => h("th", { scope: "col", class: "number" }, name)),
      ),
    ),
    body,
  );
  const count = computed(() => editor.curve().control_points_cN.length);
  const at = { row: 0, column: FORCE };
  effect(() => {
    const rows = count();
    untracked(() =>
      body.replaceChildren(...Array.from({ length: rows }, (_, row) => rowOf(editor, row, at))),
    );
  });
  grid.addEventListener("keydown", (event) => onKey(editor, body, at, event));
  grid.addEventListener("focusin", (event) => onFocus(editor, body, at, event.target));
  const add = () => addBehind(editor);
  return h(
    "div",
    { class: "stack" },
    h("div", { class: "edit-scroll" }, grid),
    h(
      "div",
      { class: "row" },
      button({ label: "Add point", act: add, hint: "After the selected one; the shape stays" }),
      button({
        label: "Remove points",
        act: () => removeSelected(editor),
        disabled: () => editor.selection().length === 0,
        hint: "Delete; the shape changes as little as possible",
      }),
    ),
  );
}

interface At {
  row: number;
  column: number;
}

function rowOf(editor: EditorController, row: number, at: At): HTMLElement {
  const position = () => controlPoints_mm(editor.curve())[row];
  const texts = [
    () => String(row + 1),
    () => (position() === undefined ? "" : shown(position()!, 4)),
    () => shown(editor.curve().control_points_cN[row] ?? 0, 4),
  ];
  const cell = (text: () => string, column: number) =>
    h(
      "td",
      {
        role: "gridcell",
        class: "number",
        tabindex: row === at.row && column === at.column ? 0 : -1,
        "aria-readonly": column === FORCE ? null : "true",
        on:
          column === FORCE
            ? { dblclick: (event) => open(editor, event.currentTarget as HTMLElement, row) }
            : {},
      },
      text,
    );
  return h(
    "tr",
    {
      role: "row",
      "aria-selected": () => String(editor.selection().includes(row)),
      on: { pointerdown: (event) => choose(editor, row, event) },
    },
    texts.map(cell),
  );
}

function choose(editor: EditorController, row: number, event: PointerEvent): void {
  if ((event.target as HTMLElement).matches("input")) return;
  const now = editor.selection.peek();
  editor.selection.set(event.shiftKey || event.ctrlKey ? toggled(now, row) : [row]);
}

function cellAt(body: HTMLElement, { row, column }: At): HTMLElement | null {
  return (body.children[row]?.children[column] as HTMLElement | undefined) ?? null;
}

function onFocus(editor: EditorController, body: HTMLElement, at: At, target: EventTarget | null): void {
  const cell = target instanceof HTMLElement ? target.closest("td") : null;
  if (!cell?.parentElement) return;
  cellAt(body, at)?.setAttribute("tabindex", "-1");
  at.row = [...body.children].indexOf(cell.parentElement);
  at.column = [...cell.parentElement.children].indexOf(cell);
  cell.tabIndex = 0;
  if (!editor.selection.peek().includes(at.row)) editor.selection.set([at.row]);
}

function onKey(editor: EditorController, body: HTMLElement, at: At, event: KeyboardEvent): void {
  if (event.target instanceof HTMLInputElement || event.altKey) return;
  const begins =
    event.key === "F2" ||
    (event.key === "Enter" && !event.shiftKey) ||
    (/^[0-9.,+-]$/.test(event.key) && !event.ctrlKey);
  if (begins && at.column === FORCE) {
    event.preventDefault();
    open(editor, cellAt(body, at)!, at.row, event.key.length === 1 ? event.key : undefined);
    return;
  }
  if (event.key === "Delete" || event.key === "Backspace") {
    event.preventDefault();
    removeSelected(editor);
    return;
  }
  const to = walked(at, event.key, event.ctrlKey, {
    rows: body.children.length,
    columns: COLUMNS.length,
    page: 8,
  });
  if (!to) return;
  event.preventDefault();
  go(editor, body, to, event.shiftKey);
}

function go(editor: EditorController, body: HTMLElement, to: At, extend: boolean): void {
  const kept = editor.selection.peek();
  batch(() => {
    editor.selection.set(extend ? [...new Set([...kept, to.row])].sort((a, b) => a - b) : [to.row]);
    cellAt(body, to)?.focus();
  });
}

/** Type into a cell: Enter and leaving set the number, Escape takes it back. */
function open(editor: EditorController, cell: HTMLElement, row: number, first?: string): void {
  const was = editor.curve().control_points_cN[row]!;
  const input = h("input", {
    type: "text",
    inputmode: "decimal",
    class: "edit-cell",
    "aria-label": `force of point ${row + 1}, cN`,
    value: first ?? String(was),
  });
  const content = [...cell.childNodes];
  let done = false;
  const close = (keep: boolean, back: boolean) => {
    if (done) return;
    done = true;
    const value = typed(input.value);
    cell.replaceChildren(...content);
    if (back) cell.focus();
    if (!keep) return;
    if (value === null) return void toast(`"${input.value}" is not a number`, "wrong");
    if (value !== was)
      editor.apply(
        setPoints([{ ...refOf(editor.curve()), values_cN: [[row, value]] }], editor.constraints.peek()),
      );
  };
  input.addEventListener("keydown", (event) => {
    event.stopPropagation();
    if (event.key === "Escape") close(false, true);
    else if (event.key === "Enter") {
      close(true, true);
      const next = cell.parentElement?.nextElementSibling?.children[FORCE] as HTMLElement | undefined;
      next?.focus();
    }
  });
  input.addEventListener("blur", () => close(true, false));
  cell.replaceChildren(input);
  input.focus();
  if (first === undefined) input.select();
}

/** Add a point half-way behind the last selected one. */
function addBehind(editor: EditorController): void {
  const positions = controlPoints_mm(editor.curve());
  const row = Math.min(
    positions.length - 2,
    editor.selection.peek().at(-1) ?? Math.floor(positions.length / 2),
  );
  const x_mm = 0.5 * (positions[row]! + positions[row + 1]!);
  if (editor.apply(addPoint(refOf(editor.curve()), Number(x_mm.toFixed(4))))) editor.selection.set([row + 1]);
}
