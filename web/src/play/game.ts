/** Temporal pointing as states, without a screen: rounds in which a bullet flies to a zone. */

/** The strip: pixels from 0, where the zone's middle is, how fast the bullet flies. */
export interface Strip {
  readonly pixels: number;
  readonly zone_px: number;
  readonly zone_half_px: number;
  readonly speed_px_s: number;
}

/** analog: a key that tells how deep it is. */
export type InputDevice = "key" | "analog" | "mouse" | "touch" | "pen";

/** Something the hand did, on the page's clock. */
export interface Press {
  readonly at_ms: number;
  readonly hand: InputDevice;
}

/**
 * wait: the strip is dark. fly: the bullet is under way. after: it is gone, a late press still counts.
 * keep: the round is sent to the server, which answers once it is on the disk. pause, over: nothing moves.
 */
export type Phase = "wait" | "fly" | "after" | "keep" | "pause" | "over";

export interface Game {
  readonly phase: Phase;
  readonly strip: Strip;
  readonly rounds: number;
  /** Rounds that are on the disk. */
  readonly kept: number;
  /** End of the wait, or when the first picture with the bullet was drawn; null in a wait that has not begun. */
  readonly from_ms: number | null;
  readonly presses: readonly Press[];
}

/** A round that is over, as it is sent to the server; times of the page. */
export interface Round {
  readonly number: number;
  readonly start_ms: number;
  /** When the bullet was drawn in the zone's middle. */
  readonly target_ms: number;
  readonly end_ms: number;
  readonly hand: InputDevice;
}

/** The dark before a bullet lasts from the first to the sum of both, so that nobody counts it out. */
const WAIT_ms = [500, 700] as const;
/** How long after the bullet left the strip a press is waited for. */
const AFTER_ms = 450;

/** kept: rounds of the trial that are on the disk already. */
export function newGame(strip: Strip, rounds: number, kept = 0): Game {
  return { phase: "wait", strip, rounds, kept, from_ms: null, presses: [] };
}

/** A picture is drawn at now_ms. luck: in [0, 1), used where a wait begins. */
export function drawn(game: Game, now_ms: number, luck: number): Game {
  if (game.phase === "wait") return waited(game, now_ms, luck);
  if (game.phase === "fly" && now_ms >= gone_ms(game)) return { ...game, phase: "after" };
  if (game.phase === "after" && now_ms >= gone_ms(game) + AFTER_ms) return { ...game, phase: "keep" };
  return game;
}

function waited(game: Game, now_ms: number, luck: number): Game {
  if (game.from_ms === null) return { ...game, from_ms: now_ms + WAIT_ms[0] + luck * WAIT_ms[1] };
  // the bullet starts with a picture, not between two
  return now_ms < game.from_ms ? game : { ...game, phase: "fly", from_ms: now_ms };
}

/** Return the pixel that is lit at now_ms, or null. */
export function lit_px(game: Game, now_ms: number): number | null {
  if (game.phase !== "fly" || game.from_ms === null) return null;
  const at = Math.floor(((now_ms - game.from_ms) / 1000) * game.strip.speed_px_s);
  return at >= 0 && at < game.strip.pixels ? at : null;
}

/** Whether what the hand does is a press of the round. */
export function listens(game: Game): boolean {
  return game.phase === "fly" || game.phase === "after";
}

/** The hand pressed; outside a round nothing happens. */
export function pressed(game: Game, press: Press): Game {
  return listens(game) ? { ...game, presses: [...game.presses, press] } : game;
}

/** Return the round to be kept; null unless it is over. */
export function round(game: Game): Round | null {
  if (game.phase !== "keep" || game.from_ms === null) return null;
  return {
    number: game.kept + 1,
    start_ms: game.from_ms,
    target_ms: game.from_ms + flight_ms(game.strip),
    end_ms: gone_ms(game) + AFTER_ms,
    hand: game.presses[0]?.hand ?? "key",
  };
}

/** The round is on the disk. */
export function kept(game: Game, number: number): Game {
  if (game.phase !== "keep" || number !== game.kept + 1) return game;
  const phase = number >= game.rounds ? "over" : "wait";
  return { ...game, phase, kept: number, from_ms: null, presses: [] };
}

/** Stop for a while: a bullet under way is flown again, a round that is being kept is waited for. */
export function paused(game: Game): Game {
  return game.phase === "over" || game.phase === "keep"
    ? game
    : { ...game, phase: "pause", from_ms: null, presses: [] };
}

export function resumed(game: Game): Game {
  return game.phase === "pause" ? { ...game, phase: "wait" } : game;
}

/** How long the bullet flies to the zone's middle: when the pixel there lights up. */
export function flight_ms(strip: Strip): number {
  return (strip.zone_px / strip.speed_px_s) * 1000;
}

function gone_ms(game: Game): number {
  return (game.from_ms ?? 0) + (game.strip.pixels / game.strip.speed_px_s) * 1000;
}
