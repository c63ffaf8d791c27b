/** Values of a declaration as they stand in its text: read for the form, and put back with all else as it was. */

export type TomlValue = string | number | boolean;

/** Find the line `key = value` of a table (empty: before the first table). */
function line(text: string, table: string, key: string): { at: number; value: string } | null {
  let inside = "";
  for (const [at, one] of text.split("\n").entries()) {
    const head = /^\s*(\[\[?[^\]]+\]\]?)/.exec(one);
    if (head) inside = head[1] === `[${table}]` ? table : "another";
    const found = inside === table ? /^\s*([\w.-]+)\s*=\s*("(?:[^"\\]|\\.)*"|[^#"]*)/.exec(one) : null;
    if (found?.[1] === key) return { at, value: (found[2] ?? "").trim() };
  }
  return null;
}

/** Return a value of a table; null where the text has none, or none of these kinds. */
export function readValue(text: string, table: string, key: string): TomlValue | null {
  const value = line(text, table, key)?.value;
  if (!value) return null;
  if (value === "true" || value === "false") return value === "true";
  if (!value.startsWith('"')) return Number.isFinite(Number(value)) ? Number(value) : null;
  try {
    return JSON.parse(value) as string;
  } catch {
    return null;
  }
}

/** Put a value in the place of the one there is; a comment behind it stays. Without one, the text stays. */
export function writeValue(text: string, table: string, key: string, value: TomlValue): string {
  const found = line(text, table, key);
  if (!found || readValue(text, table, key) === value) return text;
  const lines = text.split("\n");
  const one = lines[found.at] as string;
  const from = one.indexOf(found.value, one.indexOf("=") + 1);
  const whole = typeof value === "number" && Number.isInteger(value) && found.value.includes(".");
  const written = whole ? value.toFixed(1) : JSON.stringify(value);
  lines[found.at] = one.slice(0, from) + written + one.slice(from + found.value.length);
  return lines.join("\n");
}
