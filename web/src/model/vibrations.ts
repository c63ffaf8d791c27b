/** Edits of vibrations; one that is edited was not measured and loses its spread. */

import { g, ModelError, speed } from "../math";
import type { Edit } from "./edit";
import { foundVibration, isAt, label, vibrationAt, withVibration } from "./model";
import type { CurveRef, FDVVModel, Mode, Vibration } from "./types";

/** A short click to begin with where a stroke has no vibration yet. */
export const NEW_MODE: Mode = { frequency_Hz: 250, amplitude_m_s2: 20, decay_1_s: 100, phase_rad: 0 };

/** Add a vibration; refused if there is one at that stroke and velocity. */
export function addVibration(vibration: Vibration): Edit {
  return {
    label: `add a vibration to ${label(vibration)}`,
    change: (model) => {
      if (vibrationAt(model, vibration)) throw new ModelError(taken(vibration));
      return withVibration(model, vibration);
    },
  };
}

/** Make a vibration of one mode to begin with. */
export function newVibration(at: CurveRef, onset_mm: number, modes: readonly Mode[] = [NEW_MODE]): Vibration {
  return { stroke: at.stroke, velocity_mm_s: at.velocity_mm_s, onset_mm, duration_s: 0.05, modes };
}

/** Remove a vibration. */
export function removeVibration(at: CurveRef): Edit {
  return {
    label: `remove the vibration of ${label(at)}`,
    change: (model) => {
      const gone = foundVibration(model, at);
      return { ...model, vibrations: model.vibrations.filter((v) => v !== gone) };
    },
  };
}

/** Set where a vibration starts. */
export function setOnset(at: CurveRef, onset_mm: number): Edit {
  return changed(at, `set the onset of ${label(at)} to ${g(onset_mm)} mm`, () => ({ onset_mm }));
}

/** Set how long a vibration is. */
export function setDuration(at: CurveRef, duration_s: number): Edit {
  return changed(at, `set the duration of ${label(at)} to ${g(duration_s * 1000)} ms`, () => ({
    duration_s,
  }));
}

/** Set all modes of a vibration. */
export function setModes(at: CurveRef, modes: readonly Mode[]): Edit {
  return changed(at, `set the modes of ${label(at)}`, () => ({ modes }));
}

/** Set numbers of one mode. */
export function setMode(at: CurveRef, index: number, numbers: Partial<Mode>): Edit {
  return changed(at, `set mode ${index + 1} of ${label(at)}`, ({ modes }) => ({
    modes: modes.map((mode, i) => (i === index ? { ...mode, ...numbers } : mode)),
  }));
}

/** Add a mode. */
export function addMode(at: CurveRef, mode: Mode = NEW_MODE): Edit {
  return changed(at, `add a mode to ${label(at)}`, ({ modes }) => ({ modes: [...modes, mode] }));
}

/** Remove a mode; refused if it is the only one. */
export function removeMode(at: CurveRef, index: number): Edit {
  return changed(at, `remove mode ${index + 1} of ${label(at)}`, ({ modes }) => ({
    modes: modes.filter((_, i) => i !== index),
  }));
}

/** Copy a vibration to another stroke or velocity, replacing what is there. */
export function copyVibration(from: CurveRef, to: CurveRef): Edit {
  return {
    label: `copy the vibration of ${label(from)} to ${label(to)}`,
    change: (model) => withVibration(model, moved(foundVibration(model, from), to)),
  };
}

/** Say that a vibration is of another stroke or velocity; refused if there is one already. */
export function moveVibration(from: CurveRef, to: CurveRef): Edit {
  return {
    label: `move the vibration of ${label(from)} to ${label(to)}`,
    change: (model) => {
      const vibration = foundVibration(model, from);
      if (isAt(from, to)) return model;
      if (vibrationAt(model, to)) throw new ModelError(taken(to));
      return { ...model, vibrations: model.vibrations.map((v) => (v === vibration ? moved(v, to) : v)) };
    },
  };
}

function taken({ stroke, velocity_mm_s }: CurveRef): string {
  return `there is a ${stroke} vibration at ${speed(velocity_mm_s)} already; remove it first`;
}

function moved(vibration: Vibration, to: CurveRef): Vibration {
  return isAt(vibration, to)
    ? vibration
    : { ...bare(vibration), stroke: to.stroke, velocity_mm_s: to.velocity_mm_s };
}

function bare({ spread: _spread, ...vibration }: Vibration): Vibration {
  return vibration;
}

function changed(at: CurveRef, what: string, change: (vibration: Vibration) => Partial<Vibration>): Edit {
  return {
    label: what,
    change: (model: FDVVModel) => {
      const vibration = foundVibration(model, at);
      return withVibration(model, { ...bare(vibration), ...change(vibration) });
    },
  };
}
