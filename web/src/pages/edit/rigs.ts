/** What the chosen rig makes of the active curve, asked while the hand moves, and what presses gave. */

import { lineOf } from "../../math/words";
import type { FDVVModel } from "../../model";
import { call } from "../../net";
import type { AchievableForce, MeasuredPresses, RigChoice } from "../../net/messages";
import { effect, onCleanup, type Signal, signal, tell, untracked } from "../../ui";
import type { EditorController } from "./editor_controller";
import { Latest } from "./latest";

interface Question {
  readonly model: FDVVModel;
  readonly rig_id: string;
  readonly velocity_mm_s: number | null;
}

/** The rig's answers, for the canvas and the verdict. */
export interface RigView {
  readonly rigs: Signal<readonly RigChoice[]>;
  /** Empty: no rig is looked at. */
  readonly rig_id: Signal<string>;
  /** Both strokes at the active curve's velocity; empty while nothing is known. */
  readonly curves: Signal<readonly AchievableForce[]>;
  readonly measured: Signal<MeasuredPresses | null>;
  /** Why there is no answer; empty where there is one. */
  readonly wrong: Signal<string>;
  /** An answer is on its way for the first time. */
  readonly waiting: Signal<boolean>;
}

const CHOSEN = "fdvv-edit-rig";

/** Ask for the rigs, and for what the chosen one makes of every change of the active curve. */
export function lookAtRigs(editor: EditorController, id: () => string): RigView {
  const view: RigView = {
    rigs: signal<readonly RigChoice[]>([]),
    rig_id: signal(localStorage.getItem(CHOSEN) ?? "shipped:recommended"),
    curves: signal<readonly AchievableForce[]>([]),
    measured: signal<MeasuredPresses | null>(null),
    wrong: signal(""),
    waiting: signal(false),
  };
  call("editor.rigs", {}).then(({ rigs }) => view.rigs.set(rigs), tell);
  effect(() => {
    const name = id().slice(id().indexOf(":") + 1);
    call("editor.measured", { name }).then(({ found }) => view.measured.set(found), tell);
  });
  const latest = new Latest(
    asked,
    ({ curves }) => answered(view, curves, ""),
    (error) => answered(view, [], lineOf(error)),
  );
  onCleanup(() => latest.close());
  effect(() => {
    const [model, rig_id, { velocity_mm_s }] = [editor.model(), view.rig_id(), editor.active()];
    localStorage.setItem(CHOSEN, rig_id);
    if (rig_id === "") return untracked(() => answered(view, [], ""));
    if (!untracked(() => view.curves().length)) view.waiting.set(true);
    latest.ask({ model, rig_id, velocity_mm_s });
  });
  return view;
}

async function asked({ model, rig_id, velocity_mm_s }: Question) {
  const start = performance.now();
  const answer = await call("editor.achievable", { model, rig_id, velocities_mm_s: [velocity_mm_s] });
  performance.measure("fdvv-achievable", { start });
  performance.clearMeasures("fdvv-achievable");
  return answer;
}

function answered(view: RigView, curves: readonly AchievableForce[], wrong: string): void {
  view.curves.set(curves);
  view.wrong.set(wrong);
  view.waiting.set(false);
}
