/** Walking a table of cells by keys, as spreadsheets do. */

/** A cell of a table. */
export interface Cell {
  readonly row: number;
  readonly column: number;
}

/** How many rows and columns a table has, and how many rows a page of it. */
export interface Extent {
  readonly rows: number;
  readonly columns: number;
  readonly page: number;
}

const last = (count: number, at: number): number => Math.min(count - 1, Math.max(0, at));

/** The cell that a key leads to; null where the key does not walk. Ctrl with Home and End goes to the corners. */
export function walked(cell: Cell, key: string, ctrl: boolean, extent: Extent): Cell | null {
  const { row, column } = cell;
  const to = (r: number, c: number): Cell => ({ row: last(extent.rows, r), column: last(extent.columns, c) });
  switch (key) {
    case "ArrowUp":
      return to(ctrl ? 0 : row - 1, column);
    case "ArrowDown":
    case "Enter":
      return to(ctrl ? extent.rows - 1 : row + 1, column);
    case "ArrowLeft":
      return to(row, ctrl ? 0 : column - 1);
    case "ArrowRight":
      return to(row, ctrl ? extent.columns - 1 : column + 1);
    case "PageUp":
      return to(row - extent.page, column);
    case "PageDown":
      return to(row + extent.page, column);
    case "Home":
      return to(ctrl ? 0 : row, 0);
    case "End":
      return to(ctrl ? extent.rows - 1 : row, extent.columns - 1);
    default:
      return null;
  }
}
