/** What is pressed and how it is brought to the finger; what its address and the server's list say of it. */

import type { Route } from "../../app/route";
import type { PressItem, PressList } from "../../net/messages";
import type { Choice, Mode } from "./session";

export const MODES: readonly (readonly [Mode, string])[] = [
  ["intended", "as designed"],
  ["compensated", "on a rig, compensated"],
  ["rendered", "on a rig, not compensated"],
];

/** One of the two things that are compared. */
export interface Pick {
  /** "button builtin:mx-clear" or "program shipped:multi-level". */
  item: string;
  mode: Mode;
  rig: string;
}

/** Read what to press: what was chosen last on this page, the button of its address, else the one worked on. */
export function pickOf({ id, query }: Omit<Route, "page">, worked_on: string): Pick {
  const item = query.get("press") ?? `button ${id || worked_on || "builtin:mx-clear"}`;
  return {
    item,
    mode: (query.get("mode") as Mode | null) ?? "intended",
    rig: query.get("rig") ?? "recommended",
  };
}

/** Return the kind of an item, and its id. */
export function parted(item: string): readonly [kind: "button" | "program", id: string] {
  const [kind, id = ""] = item.split(/ (.*)/s, 2);
  return [kind === "program" ? "program" : "button", id];
}

/** Return what a pick is compared with at first. */
export function otherThan({ item }: Pick): Pick {
  const other = item === "button builtin:mx-brown" ? "mx-clear" : "mx-brown";
  return { item: `button builtin:${other}`, mode: "intended", rig: "recommended" };
}

export function choiceOf({ item, mode, rig }: Pick): Choice {
  const [kind, id] = parted(item);
  return { what: { [kind]: id }, mode, rig };
}

export function found(list: PressList | null, item: string): PressItem | undefined {
  const [kind, id] = parted(item);
  return list?.[`${kind}s`].find((one) => one.id === id);
}

export function nameOf(list: PressList | null, item: string): string {
  return found(list, item)?.name ?? item.split(":").slice(1).join(":");
}

/** What can be chosen; a measured button that the address names is on no list. */
export function options(list: PressList | null, first: string): (readonly [string, string])[] {
  const named = (kind: "button" | "program", group: string) =>
    (list?.[`${kind}s`] ?? []).map(({ id, name }) => [`${kind} ${id}`, `${group}: ${name}`] as const);
  const listed = [...named("button", "Button"), ...named("program", "Program")];
  return found(list, first) ? listed : [[first, nameOf(list, first)], ...listed];
}
