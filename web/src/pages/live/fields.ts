/** What is typed into forms, read and checked. */

import type { Setting } from "../../net";

/** Read speeds with spaces or commas between them; a line of text says what is wrong. */
export function speedsOf(text: string, setting: Setting): readonly number[] | string {
  const { least, most, longest } = setting;
  const parts = text.split(/[\s,;]+/).filter(Boolean);
  const speeds = parts.map(Number);
  if (!speeds.length || speeds.length > (longest ?? 1)) return `enter 1 to ${longest} speeds`;
  if (!speeds.every((v) => Number.isFinite(v) && v >= (least ?? 0) && v <= (most ?? 0))) {
    return `use numbers from ${least} to ${most} mm/s`;
  }
  if (new Set(speeds).size !== speeds.length) return "a speed is listed twice";
  return speeds;
}

/** What a form of settings begins with. */
export function defaultsOf<T>(settings: Readonly<Record<string, Setting>>): T {
  return Object.fromEntries(Object.entries(settings).map(([name, one]) => [name, one.default])) as T;
}

/** Name what comes out of work on a button, as a file may be named. */
export function nameFor(button: string, added: string): string {
  const name = button.slice(button.indexOf(":") + 1).replace(/[^\p{L}\p{N} .+()-]+/gu, "-");
  return `${name}${added}`.slice(0, 80);
}
