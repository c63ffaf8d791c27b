/** The wave of a vibration over time, with handles for amplitude, decay and frequency of one mode. */

import { type Brush, Plot, palette, series, type View } from "../../draw";
import { acceleration_m_s2 } from "../../math";
import { type Edit, type Mode, setMode, type Vibration } from "../../model";
import { type CurveToolState, cancelled, IDLE, pointerStep } from "../../tools/curve_tool";
import type { HandleShown, Scene } from "../../tools/reach";
import type { Act } from "../../tools/records";
import { computed, onCleanup, type Signal } from "../../ui";
import { type EditorController, refOf } from "./editor_controller";
import { pointerRecord } from "./events";
import { inPixels } from "./samples";
import { decayTo, envelope_m_s2, timeAt_s, times_s } from "./wave";

const HALF = 0.5;
type Serving = () => Vibration | null;
type Handle = "amplitude" | "decay" | "frequency";

/** The plot; what is dragged is one undo step. */
export function wavePlot(editor: EditorController, serving: Serving, chosen: Signal<number>): HTMLElement {
  const whole = computed(() => rangesOf(editor, serving));
  const plot = new Plot({
    label: "Acceleration of the cap over time",
    x: { label: "time", unit: "ms" },
    y: { label: "acceleration", unit: "m/s²" },
    whole: () => whole() ?? { x: { low: 0, high: 10 }, y: { low: -1, high: 1 } },
    moving: (brush, view) => paint(brush, view, serving(), chosen()),
    height_px: 210,
  });
  listen(plot, editor, serving, chosen);
  return plot.element;
}

/** The axes of the vibration as it was before a drag began. */
function rangesOf(editor: EditorController, serving: Serving) {
  editor.settled();
  const now = serving();
  const v =
    now &&
    editor
      .settled()
      .vibrations.find(
        (vibration) => vibration.stroke === now.stroke && vibration.velocity_mm_s === now.velocity_mm_s,
      );
  if (!v) return null;
  const most = v.modes.reduce((sum, mode) => sum + Math.abs(mode.amplitude_m_s2), 0) * 1.15 || 1;
  return {
    x: { low: -0.02 * v.duration_s * 1000, high: v.duration_s * 1020 },
    y: { low: -most, high: most },
  };
}

function paint(brush: Brush, view: View, v: Vibration | null, chosen: number): void {
  if (!v) return;
  const { muted, surface, text } = palette();
  const t_s = times_s(v.modes, v.duration_s);
  const ms = inPixels(
    view.x,
    t_s.map((t) => 1000 * t),
  );
  v.modes.forEach((mode, i) => {
    const { colour, dash } = series(i + 1);
    const envelope = envelope_m_s2(mode, t_s);
    const style = { colour, dash: i === chosen ? [] : dash, width_px: i === chosen ? 1.6 : 1, opacity: 0.7 };
    brush.line(ms, inPixels(view.y, envelope), style);
    brush.line(
      ms,
      inPixels(
        view.y,
        envelope.map((a) => -a),
      ),
      { ...style, opacity: 0.35 },
    );
  });
  const zero = view.y.px(0);
  brush.line([view.box.left, view.box.left + view.box.width], [zero, zero], { colour: muted, opacity: 0.6 });
  brush.line(ms, inPixels(view.y, acceleration_m_s2(v, t_s)), { colour: series(0).colour, width_px: 2 });
  const mode = v.modes[chosen];
  if (!mode) return;
  const { colour } = series(chosen + 1);
  for (const at of handles(view, mode, v.duration_s)) {
    brush.circle(at, 5.5, { colour: surface }, { colour, width_px: 2.4 });
    brush.text(
      WORDS[at.name as Handle](mode),
      { x_px: at.x_px + 10, y_px: at.y_px },
      { colour: text, size_px: 11, halo: surface },
    );
  }
}

const WORDS: Readonly<Record<Handle, (mode: Mode) => string>> = {
  amplitude: (mode) => `${mode.amplitude_m_s2.toPrecision(3)} m/s²`,
  decay: (mode) => `half after ${(1000 * (Math.LN2 / Math.max(1e-9, mode.decay_1_s))).toPrecision(3)} ms`,
  frequency: (mode) => `${mode.frequency_Hz.toPrecision(4)} Hz`,
};

/** Where the handles lie: amplitude at the onset, decay at half of it, frequency at the end of the first turn. */
function handles(view: View, mode: Mode, duration_s: number): HandleShown[] {
  const at = (name: Handle, t_s: number, a: number) => ({
    name,
    x_px: view.x.px(1000 * t_s),
    y_px: view.y.px(a),
  });
  const size = Math.abs(mode.amplitude_m_s2);
  return [
    at("amplitude", 0, size),
    at("decay", timeAt_s(mode, HALF, duration_s), HALF * size),
    at("frequency", Math.min(duration_s, 1 / mode.frequency_Hz), -0.6 * size),
  ];
}

function listen(plot: Plot, editor: EditorController, serving: Serving, chosen: Signal<number>): void {
  let state: CurveToolState = IDLE;
  let mark: {
    readonly view: View;
    readonly v: Vibration;
    readonly mode: Mode;
    readonly index: number;
  } | null = null;
  const act = (one: Act) => {
    if (one.kind === "begin") {
      const [v, index] = [serving()!, chosen.peek()];
      mark = { view: plot.view(), v, mode: v.modes[index]!, index };
      editor.mark("shape the vibration");
    } else if (one.kind === "shift" && mark && one.grip.kind === "handle") {
      const { view, mode, v, index } = mark;
      const at = handles(view, mode, v.duration_s).find(
        (handle) => handle.name === (one.grip as { name: string }).name,
      )!;
      const [t_s, a] = [
        view.x.value(at.x_px + one.offset.dx_px) / 1000,
        view.y.value(at.y_px + one.offset.dy_px),
      ];
      editor.drag(shaped(v, index, mode, at.name as Handle, t_s, a));
    } else if (one.kind === "commit") editor.release();
    else if (one.kind === "cancel") editor.cancel();
  };
  const take = (event: PointerEvent) => {
    const position = plot.at(event);
    if (event.type === "pointerdown") plot.element.setPointerCapture(event.pointerId);
    const answer = pointerStep(
      state,
      pointerRecord(event, position),
      sceneOf(plot.view(), serving(), chosen.peek()),
    );
    state = answer.state;
    answer.acts.forEach(act);
  };
  for (const name of ["pointerdown", "pointermove", "pointerup", "pointercancel"] as const)
    plot.element.addEventListener(name, take);
  const onEscape = (event: KeyboardEvent) => {
    if (event.key !== "Escape") return;
    const answer = cancelled(state);
    state = answer.state;
    answer.acts.forEach(act);
  };
  addEventListener("keydown", onEscape);
  onCleanup(() => removeEventListener("keydown", onEscape));
}

function shaped(v: Vibration, index: number, mode: Mode, handle: Handle, t_s: number, a: number): Edit {
  const sign = mode.amplitude_m_s2 < 0 ? -1 : 1;
  if (handle === "amplitude")
    return setMode(refOf(v), index, { amplitude_m_s2: sign * Math.max(0, Number(a.toPrecision(4))) });
  if (handle === "decay")
    return setMode(refOf(v), index, { decay_1_s: Number(decayTo(HALF, t_s).toPrecision(4)) });
  return setMode(refOf(v), index, { frequency_Hz: Number((1 / Math.max(1e-4, t_s)).toPrecision(4)) });
}

function sceneOf(view: View, v: Vibration | null, chosen: number): Scene {
  const mode = v?.modes[chosen];
  const found = v && mode ? handles(view, mode, v.duration_s) : [];
  return { points: [], handles: found, away_px: () => Infinity, nearestCurve: () => null, selection: [] };
}
