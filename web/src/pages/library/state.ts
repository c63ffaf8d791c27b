/** What the library shows, and how that stands in the address, so that a link shows it again. */

import type { ButtonType, LibraryFind, Origin } from "../../net/messages";

export type ViewName = "force" | "slope" | "work";
export type TabName = "landmarks" | "alike" | "about";

export interface RangeAsked {
  readonly low: number | null;
  readonly high: number | null;
}

export interface Query {
  readonly text: string;
  readonly kinds: readonly ButtonType[];
  readonly origins: readonly Origin[];
  readonly ranges: Readonly<Record<string, RangeAsked>>;
  readonly like: string | null;
  readonly sort: string;
  readonly descending: boolean;
}

export interface Shown {
  /** Ids of the buttons that are compared, the reference among them. */
  readonly overlay: readonly string[];
  readonly reference: string | null;
  readonly view: ViewName;
  readonly tab: TabName;
  readonly press: boolean;
  readonly release: boolean;
  readonly marks: boolean;
  readonly loss: boolean;
  /** Curves nearest to this speed are drawn; null for the slowest of each. */
  readonly velocity_mm_s: number | null;
}

export const EVERYTHING: Query = {
  text: "",
  kinds: [],
  origins: [],
  ranges: {},
  like: null,
  sort: "match",
  descending: false,
};
export const AT_FIRST: Shown = {
  overlay: [],
  reference: null,
  view: "force",
  tab: "landmarks",
  press: true,
  release: true,
  marks: true,
  loss: false,
  velocity_mm_s: null,
};

const KINDS: readonly ButtonType[] = ["linear", "tactile", "clicky?", "dome?", "unclear"];
const ORIGINS: readonly Origin[] = ["builtin", "own", "measured"];
const SWITCHES = ["press", "release", "marks", "loss"] as const;
/** Most that is compared at once; the server gives no more at a time. */
export const MOST = 60;

export function writeState(query: Query, shown: Shown): URLSearchParams {
  const found = new URLSearchParams();
  const put = (name: string, value: string, usual = "") => {
    if (value !== usual) found.set(name, value);
  };
  put("q", query.text);
  put("kind", query.kinds.join(","));
  put("from", query.origins.join(","));
  for (const [name, range] of Object.entries(query.ranges))
    put(name, `${range.low ?? ""}..${range.high ?? ""}`, "..");
  put("like", query.like ?? "");
  put("sort", `${query.descending ? "-" : ""}${query.sort}`, "match");
  for (const id of shown.overlay) found.append("over", id);
  put("ref", shown.reference ?? "", shown.overlay[0] ?? "");
  put("view", shown.view, AT_FIRST.view);
  put("tab", shown.tab, AT_FIRST.tab);
  for (const name of SWITCHES) put(name, shown[name] ? "1" : "0", AT_FIRST[name] ? "1" : "0");
  put("speed", shown.velocity_mm_s === null ? "" : String(shown.velocity_mm_s));
  return found;
}

/** Read an address; what it does not say, or says wrong, is as at first. */
export function readState(from: URLSearchParams): { readonly query: Query; readonly shown: Shown } {
  const sort = from.get("sort") ?? "match";
  const overlay = [...new Set(from.getAll("over"))].slice(0, MOST);
  const reference = from.get("ref");
  const speed = Number(from.get("speed") || NaN);
  return {
    query: {
      text: (from.get("q") ?? "").slice(0, 200),
      kinds: listed(from.get("kind"), KINDS),
      origins: listed(from.get("from"), ORIGINS),
      ranges: ranges(from),
      like: from.get("like") || null,
      sort: sort.replace(/^-/, ""),
      descending: sort.startsWith("-"),
    },
    shown: {
      overlay,
      reference: reference && overlay.includes(reference) ? reference : (overlay[0] ?? null),
      view: oneOf(from.get("view"), ["force", "slope", "work"], AT_FIRST.view),
      tab: oneOf(from.get("tab"), ["landmarks", "alike", "about"], AT_FIRST.tab),
      press: said(from, "press"),
      release: said(from, "release"),
      marks: said(from, "marks"),
      loss: said(from, "loss"),
      velocity_mm_s: Number.isFinite(speed) && speed > 0 ? speed : null,
    },
  };
}

function said(from: URLSearchParams, name: (typeof SWITCHES)[number]): boolean {
  return from.has(name) ? from.get(name) === "1" : AT_FIRST[name];
}

function listed<T extends string>(text: string | null, known: readonly T[]): T[] {
  const asked = (text ?? "").split(",");
  return known.filter((one) => asked.includes(one));
}

function oneOf<T extends string>(text: string | null, known: readonly T[], usual: T): T {
  return known.find((one) => one === text) ?? usual;
}

/** Ranges are the names that hold two dots; the server knows which names there are. */
function ranges(from: URLSearchParams): Record<string, RangeAsked> {
  const found: Record<string, RangeAsked> = {};
  for (const [name, text] of from) {
    const match = /^(-?[\d.]*)\.\.(-?[\d.]*)$/.exec(text);
    if (!match || !/_(cN|mm|mJ|cN_mm|ratio)$/.test(name)) continue;
    const range = { low: number(match[1]), high: number(match[2]) };
    if (range.low !== null || range.high !== null) found[name] = range;
  }
  return found;
}

function number(text: string | undefined): number | null {
  const value = Number(text || NaN);
  return Number.isFinite(value) ? value : null;
}

/** Return the query as the server takes it. */
export function asked(query: Query): LibraryFind {
  return { ...query };
}
