/** Traces of keys: shipped ones, or a file of one's own, led through the button that is under the finger. */

import { call } from "../../net";
import type { TraceItem, TraceRead } from "../../net/messages";
import { button, h, shown, signal, svg, tell } from "../../ui";
import type { PressSession } from "./session";

const LARGEST_bytes = 4_000_000;
const PICTURE = { width: 84, height: 26, deepest_mm: 4.2 };

export function replayPanel(session: PressSession, traces: readonly TraceItem[]): HTMLElement {
  const read = signal<readonly TraceRead[]>([]);
  const play = (trace: TraceItem | TraceRead) =>
    session.replay(
      "told" in trace && isRead(trace, read.peek())
        ? { name: trace.name, t_s: trace.t_s, displacement_mm: trace.displacement_mm }
        : { name: trace.name },
    );
  const row = (trace: TraceItem | TraceRead) =>
    h(
      "li",
      {},
      button({ label: trace.name, act: () => play(trace), hint: trace.told }),
      picture(trace),
      h("span", { class: "muted" }, `${shown(trace.t_s.at(-1) ?? 0, 1)} s`),
    );
  const file: HTMLInputElement = h("input", {
    type: "file",
    accept: ".csv,.json,.txt",
    class: "visually-hidden",
    tabindex: -1,
    "aria-label": "A CSV or JSON file of a key's travel",
    on: { change: () => void open() },
  });
  const open = async () => {
    const chosen = file.files?.[0];
    file.value = "";
    if (!chosen) return;
    try {
      if (chosen.size > LARGEST_bytes) throw new Error(`${chosen.name} is larger than 4 MB; shorten it`);
      const found = await call("press.trace", { name: chosen.name, text: await chosen.text() });
      read.update((list) => [...list.filter((one) => one.name !== found.name), found]);
      play(found);
    } catch (error) {
      tell(error);
    }
  };
  return h(
    "details",
    { class: "press-replay" },
    h("summary", {}, "Replay a key's movement"),
    h("ul", {}, () => [...traces, ...read()].map(row)),
    h(
      "div",
      { class: "row" },
      button({
        label: "Open a trace …",
        act: () => file.click(),
        hint: "CSV or JSON with columns t_s and displacement_mm",
      }),
      file,
    ),
    h(
      "p",
      { class: "muted" },
      "The finger follows the trace as a practised person would. The shipped traces are synthetic.",
    ),
  );
}

function isRead(trace: { readonly name: string }, read: readonly TraceRead[]): boolean {
  return read.some((one) => one === trace);
}

function picture(trace: {
  readonly t_s: readonly number[];
  readonly displacement_mm: readonly number[];
}): SVGElement {
  const { width, height, deepest_mm } = PICTURE;
  const end_s = trace.t_s.at(-1) || 1;
  const points = trace.t_s.map(
    (t, i) =>
      `${((t / end_s) * width).toFixed(1)},${(((trace.displacement_mm[i] as number) / deepest_mm) * (height - 4) + 2).toFixed(1)}`,
  );
  const line = svg("polyline", {
    points: points.join(" "),
    fill: "none",
    stroke: "currentColor",
    "stroke-width": "1.5",
  });
  return svg("svg", { width, height, viewBox: `0 0 ${width} ${height}`, "aria-hidden": "true" }, line);
}
