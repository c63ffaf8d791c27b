/** Hand a file that was made in the page to the person. */

import { h } from "../ui/element";

export function download(name: string, content: Blob | string, type = "text/plain"): void {
  const blob = typeof content === "string" ? new Blob([content], { type }) : content;
  const address = URL.createObjectURL(blob);
  h("a", { href: address, download: name }).click();
  setTimeout(() => URL.revokeObjectURL(address), 10_000);
}

/** Write columns as CSV; columns of different length leave cells empty. Text that a sheet could run is quoted as text. */
export function csv(columns: readonly (readonly [string, ArrayLike<number | string>])[]): string {
  const rows = Math.max(0, ...columns.map(([, values]) => values.length));
  const lines = [columns.map(([name]) => cell(name)).join(",")];
  for (let i = 0; i < rows; i++) lines.push(columns.map(([, values]) => cell(values[i] ?? "")).join(","));
  return `${lines.join("\n")}\n`;
}

function cell(value: number | string): string {
  if (typeof value === "number") return Number.isFinite(value) ? String(value) : "";
  const safe = /^[=+\-@\t\r]/.test(value) ? `'${value}` : value;
  return /[",\n\r]/.test(safe) ? `"${safe.replaceAll('"', '""')}"` : safe;
}
