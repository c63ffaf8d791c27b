/** Changes of a program's states and transitions: pure, every name that is referred to stays one that exists. */

import type { Condition, ProgramDocument, State, Stroke, Transition, VibrationEvent } from "./document";
import { freeName, transitionsOf } from "./document";

/** Change fields of the program itself. */
export function changeProgram(document: ProgramDocument, change: Partial<ProgramDocument>): ProgramDocument {
  return { ...document, ...change };
}

/** Change some of a list's items. */
function mapAt<T>(list: readonly T[], index: number, change: (item: T) => T): readonly T[] {
  return list.map((item, i) => (i === index ? change(item) : item));
}

function withoutAt<T>(list: readonly T[], index: number): readonly T[] {
  return list.filter((_, i) => i !== index);
}

function withStates(document: ProgramDocument, change: (state: State) => State): ProgramDocument {
  return { ...document, states: document.states.map(change) };
}

function withTransitions(
  state: State,
  change: (list: readonly Transition[]) => readonly Transition[],
): State {
  return { ...state, transitions: change(transitionsOf(state)) };
}

function withVibrations(
  document: ProgramDocument,
  change: (list: readonly VibrationEvent[]) => readonly VibrationEvent[],
): ProgramDocument {
  return document.vibrations ? { ...document, vibrations: change(document.vibrations) } : document;
}

/** Add a state that feels like another one, by default like the start; give the document and its name. */
export function addState(
  document: ProgramDocument,
  like = document.start,
  wanted = "state",
): readonly [ProgramDocument, string] {
  const model = document.states.find((state) => state.name === like) ?? document.states[0];
  const name = freeName(
    wanted,
    document.states.map((state) => state.name),
  );
  const surface = document.surfaces[0]?.name ?? "";
  const fresh: State = { name, press: model?.press ?? surface, release: model?.release ?? surface };
  return [{ ...document, states: [...document.states, fresh] }, name];
}

/** Copy a state with all it does; ways to itself lead to the copy. */
export function duplicateState(document: ProgramDocument, name: string): readonly [ProgramDocument, string] {
  const source = document.states.find((state) => state.name === name);
  if (!source) return [document, name];
  const copied = freeName(
    name,
    document.states.map((state) => state.name),
  );
  const turned = (transition: Transition): Transition =>
    transition.to === name ? { ...transition, to: copied } : transition;
  const fresh = withTransitions({ ...source, name: copied }, (list) => list.map(turned));
  const events = withVibrations(document, (list) =>
    list.map((event) =>
      event.states?.includes(name) ? { ...event, states: [...event.states, copied] } : event,
    ),
  );
  return [{ ...events, states: [...document.states, fresh] }, copied];
}

/** Remove a state with every way to it; the last one stays. A vibration only it had goes too. */
export function removeState(document: ProgramDocument, name: string): ProgramDocument {
  if (document.states.length <= 1) return document;
  const states = document.states
    .filter((state) => state.name !== name)
    .map((state) => withTransitions(state, (list) => list.filter((transition) => transition.to !== name)));
  const start = document.start === name ? states[0]!.name : document.start;
  return withVibrations({ ...document, states, start }, (list) =>
    list
      .filter((event) => !(event.states?.length === 1 && event.states[0] === name))
      .map((event) =>
        event.states ? { ...event, states: event.states.filter((state) => state !== name) } : event,
      ),
  );
}

/** Rename a state wherever it is referred to. */
export function renameState(document: ProgramDocument, name: string, to: string): ProgramDocument {
  const turned = (held: string): string => (held === name ? to : held);
  const renamed = withStates(document, (state) =>
    withTransitions({ ...state, name: turned(state.name) }, (list) =>
      list.map((transition) => ({ ...transition, to: turned(transition.to) })),
    ),
  );
  return withVibrations({ ...renamed, start: turned(document.start) }, (list) =>
    list.map((event) => (event.states ? { ...event, states: event.states.map(turned) } : event)),
  );
}

/** Change fields of a state. What does not go together is set right: a repeat needs both its fields. */
export function changeState(
  document: ProgramDocument,
  name: string,
  change: Partial<State>,
): ProgramDocument {
  return withStates(document, (state) => (state.name === name ? settled({ ...state, ...change }) : state));
}

function settled(state: State): State {
  const repeats = Boolean(state.repeat_signal);
  const ramp = (state.bias_ms ?? 0) > 0;
  return {
    ...state,
    repeat_signal: repeats ? (state.repeat_signal ?? null) : null,
    repeat_ms: repeats ? state.repeat_ms || 250 : 0,
    bias_end_cN: ramp ? (state.bias_end_cN ?? 0) : 0,
  };
}

/** Say which state is entered first. */
export function setStart(document: ProgramDocument, name: string): ProgramDocument {
  return { ...document, start: name };
}

/** Add a way from one state to another; it is tried last. */
export function addTransition(
  document: ProgramDocument,
  from: string,
  to: string,
  when: Condition,
): ProgramDocument {
  return withStates(document, (state) =>
    state.name === from ? withTransitions(state, (list) => [...list, { to, when }]) : state,
  );
}

/** Remove the way of that number. */
export function removeTransition(document: ProgramDocument, from: string, index: number): ProgramDocument {
  return withStates(document, (state) =>
    state.name === from ? withTransitions(state, (list) => withoutAt(list, index)) : state,
  );
}

/** Change fields of a way. */
export function changeTransition(
  document: ProgramDocument,
  from: string,
  index: number,
  change: Partial<Transition>,
): ProgramDocument {
  return withStates(document, (state) =>
    state.name === from
      ? withTransitions(state, (list) => mapAt(list, index, (transition) => ({ ...transition, ...change })))
      : state,
  );
}

/** Let a way begin at another state; there it is tried last. Give the document and its new number. */
export function moveTransitionTo(
  document: ProgramDocument,
  from: string,
  index: number,
  other: string,
): readonly [ProgramDocument, number] {
  const transition = transitionsOf(document.states.find((state) => state.name === from)!)[index];
  const target = document.states.find((state) => state.name === other);
  if (!transition || !target || from === other) return [document, index];
  const left = removeTransition(document, from, index);
  const added = withStates(left, (state) =>
    state.name === other ? withTransitions(state, (list) => [...list, transition]) : state,
  );
  return [added, transitionsOf(target).length];
}

/** Try a way earlier (-1) or later (+1) than its neighbour. */
export function reorderTransition(
  document: ProgramDocument,
  from: string,
  index: number,
  by: -1 | 1,
): ProgramDocument {
  return withStates(document, (state) => {
    const list = [...transitionsOf(state)];
    const other = list[index + by];
    if (state.name !== from || !other || !list[index]) return state;
    [list[index], list[index + by]] = [other, list[index]!];
    return { ...state, transitions: list };
  });
}

/** Let a state's stroke feel another surface. */
export function assignSurface(
  document: ProgramDocument,
  state: string,
  stroke: Stroke | "both",
  surface: string,
): ProgramDocument {
  const change = stroke === "both" ? { press: surface, release: surface } : { [stroke]: surface };
  return changeState(document, state, change);
}
