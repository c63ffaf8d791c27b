/** Changes of a program's surfaces, signals and vibrations: pure, names that are referred to stay known. */

import type { ProgramDocument, Signal, State, Stroke, Surface, Transition, VibrationEvent } from "./document";
import { freeName, surfaceNamed } from "./document";
import { assignSurface } from "./edits";

/** Which states feel a surface, and in which stroke. */
export function usesOfSurface(
  document: ProgramDocument,
  name: string,
): readonly { state: string; stroke: Stroke }[] {
  return document.states.flatMap((state) =>
    (["press", "release"] as const)
      .filter((stroke) => state[stroke] === name)
      .map((stroke) => ({ state: state.name, stroke })),
  );
}

/** Add a surface under its name or the next free one; give the document and that name. */
export function addSurface(document: ProgramDocument, surface: Surface): readonly [ProgramDocument, string] {
  const name = freeName(
    surface.name,
    document.surfaces.map((surface) => surface.name),
  );
  return [{ ...document, surfaces: [...document.surfaces, { ...surface, name }] }, name];
}

/** Replace the forces of a surface, for every stroke that uses it. */
export function replaceSurface(document: ProgramDocument, name: string, surface: Surface): ProgramDocument {
  const surfaces = document.surfaces.map((old) => (old.name === name ? { ...surface, name } : old));
  return { ...document, surfaces };
}

/** Rename a surface wherever it is referred to. */
export function renameSurface(document: ProgramDocument, name: string, to: string): ProgramDocument {
  const turned = (held: string): string => (held === name ? to : held);
  return {
    ...document,
    surfaces: document.surfaces.map((surface) => ({ ...surface, name: turned(surface.name) })),
    states: document.states.map((state) => ({
      ...state,
      press: turned(state.press),
      release: turned(state.release),
    })),
  };
}

/** Remove a surface that no state feels; one in use stays. */
export function removeSurface(document: ProgramDocument, name: string): ProgramDocument {
  if (usesOfSurface(document, name).length > 0 || document.surfaces.length <= 1) return document;
  return { ...document, surfaces: document.surfaces.filter((surface) => surface.name !== name) };
}

/**
 * Return a state's stroke a surface of its own, so that a change is felt there alone; nothing changes if no
 * other refers to it. Gives the document and the surface's name.
 */
export function ownSurface(
  document: ProgramDocument,
  state: string,
  stroke: Stroke,
): readonly [ProgramDocument, string] {
  const name = document.states.find((held) => held.name === state)?.[stroke] ?? "";
  const surface = surfaceNamed(document, name);
  if (!surface || usesOfSurface(document, name).length <= 1) return [document, name];
  const [added, fresh] = addSurface(document, { ...surface, name: `${state} ${stroke}`.slice(0, 40).trim() });
  return [assignSurface(added, state, stroke, fresh), fresh];
}

/** Copy the forces of one state's stroke to another's, as a surface of its own there. */
export function copySurface(
  document: ProgramDocument,
  from: { readonly state: string; readonly stroke: Stroke },
  to: { readonly state: string; readonly stroke: Stroke },
): ProgramDocument {
  const source = surfaceNamed(
    document,
    document.states.find((state) => state.name === from.state)?.[from.stroke] ?? "",
  );
  if (!source) return document;
  const [owned, name] = ownSurface(document, to.state, to.stroke);
  return replaceSurface(owned, name, source);
}

/** Add a signal under its name or the next free one; give the document and that name. */
export function addSignal(document: ProgramDocument, signal: Signal): readonly [ProgramDocument, string] {
  const held = document.signals ?? [];
  const name = freeName(
    signal.name,
    held.map((known) => known.name),
  );
  return [{ ...document, signals: [...held, { ...signal, name }] }, name];
}

/** Change fields of a signal but its name. */
export function changeSignal(
  document: ProgramDocument,
  name: string,
  change: Partial<Signal>,
): ProgramDocument {
  const signals = (document.signals ?? []).map((signal) =>
    signal.name === name ? { ...signal, ...change, name } : signal,
  );
  return { ...document, signals };
}

/** Rename a signal wherever it is referred to. */
export function renameSignal(document: ProgramDocument, name: string, to: string): ProgramDocument {
  const turned = (held: string | null | undefined): string | null => (held === name ? to : (held ?? null));
  return withSignals(
    document,
    turned,
    (held) => (held.name === name ? [{ ...held, name: to }] : [held]),
    () => true,
  );
}

/** Remove a signal and whatever plays it. */
export function removeSignal(document: ProgramDocument, name: string): ProgramDocument {
  const turned = (held: string | null | undefined): string | null => (held === name ? null : (held ?? null));
  return withSignals(
    document,
    turned,
    (held) => (held.name === name ? [] : [held]),
    (event) => event.signal !== name,
  );
}

function withSignals(
  document: ProgramDocument,
  turned: (held: string | null | undefined) => string | null,
  signals: (held: Signal) => Signal[],
  keep: (event: VibrationEvent) => boolean,
): ProgramDocument {
  const transition = (held: Transition): Transition => ({ ...held, signal: turned(held.signal) });
  const state = (held: State): State => {
    const repeat_signal = turned(held.repeat_signal);
    return {
      ...held,
      enter_signal: turned(held.enter_signal),
      repeat_signal,
      repeat_ms: repeat_signal ? (held.repeat_ms ?? 0) : 0,
      transitions: (held.transitions ?? []).map(transition),
    };
  };
  return {
    ...document,
    states: document.states.map(state),
    signals: (document.signals ?? []).flatMap(signals),
    vibrations: (document.vibrations ?? [])
      .filter(keep)
      .map((event) => ({ ...event, signal: turned(event.signal) ?? event.signal })),
  };
}

/** Tie a signal to a displacement. */
export function addVibration(document: ProgramDocument, event: VibrationEvent): ProgramDocument {
  return { ...document, vibrations: [...(document.vibrations ?? []), event] };
}

/** Change fields of a vibration. */
export function changeVibration(
  document: ProgramDocument,
  index: number,
  change: Partial<VibrationEvent>,
): ProgramDocument {
  const vibrations = (document.vibrations ?? []).map((vibration, i) =>
    i === index ? { ...vibration, ...change } : vibration,
  );
  return { ...document, vibrations };
}

/** Remove a vibration. */
export function removeVibration(document: ProgramDocument, index: number): ProgramDocument {
  return { ...document, vibrations: (document.vibrations ?? []).filter((_, i) => i !== index) };
}

/** Return the vibrations that are felt in a state. */
export function vibrationsIn(document: ProgramDocument, state: string): readonly VibrationEvent[] {
  return (document.vibrations ?? []).filter((event) => !event.states?.length || event.states.includes(state));
}
