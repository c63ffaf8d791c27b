/** When a key counts as down: actuation and reset point, rapid trigger. */

/**
 * actuation_mm: the key goes down here. reset_mm: it is up above this, whatever happened below.
 * rapid: between the two events only the way back counts: release_mm up from the deepest place lets the key go,
 * press_mm down from the shallowest presses it again, until it was above reset_mm.
 */
export interface TriggerSettings {
  readonly actuation_mm: number;
  readonly reset_mm: number;
  readonly rapid: boolean;
  readonly press_mm: number;
  readonly release_mm: number;
}

/**
 * engaged: the key went down and was not above the reset point since.
 * turn_mm: the deepest place since it went down, or the shallowest since it was let go.
 */
export interface TriggerState {
  readonly down: boolean;
  readonly engaged: boolean;
  readonly turn_mm: number;
}

export const DEFAULTS: TriggerSettings = {
  actuation_mm: 1.5,
  reset_mm: 1.3,
  rapid: false,
  press_mm: 0.3,
  release_mm: 0.3,
};
export const RESTING: TriggerState = { down: false, engaged: false, turn_mm: 0 };
/** Between actuation and reset; else a key that lies still could be both. */
export const LEAST_mm = 0.05;

/** Change settings; the reset point stays above the actuation point. */
export function changed(now: TriggerSettings, by: Partial<TriggerSettings>): TriggerSettings {
  const next = { ...now, ...by };
  const actuation_mm = Math.max(next.actuation_mm, LEAST_mm);
  if (next.reset_mm <= actuation_mm - LEAST_mm + 1e-9) return { ...next, actuation_mm };
  return by.reset_mm === undefined
    ? { ...next, actuation_mm, reset_mm: actuation_mm - LEAST_mm }
    : { ...next, actuation_mm: next.reset_mm + LEAST_mm };
}

/** The key is at a depth. */
export function moved(state: TriggerState, depth_mm: number, set: TriggerSettings): TriggerState {
  if (!state.engaged)
    return depth_mm >= set.actuation_mm ? { down: true, engaged: true, turn_mm: depth_mm } : state;
  if (depth_mm <= set.reset_mm) return RESTING;
  if (!set.rapid) return state;
  return state.down ? pressed(state, depth_mm, set) : released(state, depth_mm, set);
}

function pressed(state: TriggerState, depth_mm: number, { release_mm }: TriggerSettings): TriggerState {
  if (state.turn_mm - depth_mm >= release_mm) return { down: false, engaged: true, turn_mm: depth_mm };
  return depth_mm > state.turn_mm ? { ...state, turn_mm: depth_mm } : state;
}

function released(state: TriggerState, depth_mm: number, { press_mm }: TriggerSettings): TriggerState {
  if (depth_mm - state.turn_mm >= press_mm) return { down: true, engaged: true, turn_mm: depth_mm };
  return depth_mm < state.turn_mm ? { ...state, turn_mm: depth_mm } : state;
}

/** What actuations were like: how many, how long the last was held, how long after the one before it came. */
export interface Actuations {
  readonly count: number;
  readonly held_ms: number | null;
  readonly apart_ms: number | null;
  readonly since_ms: number | null;
}

export const NONE: Actuations = { count: 0, held_ms: null, apart_ms: null, since_ms: null };

/** The key went down or up at a time. */
export function counted(all: Actuations, down: boolean, at_ms: number): Actuations {
  const { count, since_ms } = all;
  if (!down) return { ...all, held_ms: since_ms === null ? null : at_ms - since_ms };
  return {
    count: count + 1,
    held_ms: null,
    apart_ms: since_ms === null ? null : at_ms - since_ms,
    since_ms: at_ms,
  };
}
