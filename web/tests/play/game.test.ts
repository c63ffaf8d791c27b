/** The rounds of temporal pointing, frame by frame. */

import { describe, expect, it } from "vitest";
import {
  drawn,
  flight_ms,
  type Game,
  kept,
  listens,
  lit_px,
  newGame,
  paused,
  pressed,
  resumed,
  round,
} from "../../src/play/game";

const EASY = { pixels: 144, zone_px: 120, zone_half_px: 3, speed_px_s: 100 };
const HARD = { ...EASY, speed_px_s: 150 };
const FRAME_ms = 1000 / 60;

/** Draw pictures until something is so; gives the game and the time of the last picture. */
function until(
  game: Game,
  now_ms: number,
  found: (game: Game) => boolean,
  luck = 0,
): { game: Game; now_ms: number } {
  for (let at = now_ms; at < now_ms + 10_000; at += FRAME_ms) {
    game = drawn(game, at, luck);
    if (found(game)) return { game, now_ms: at };
  }
  throw new Error(`the game stays in ${game.phase}`);
}

function flying(strip = EASY): { game: Game; now_ms: number } {
  return until(newGame(strip, 2), 1000, (game) => game.phase === "fly");
}

describe("a round", () => {
  it.each([
    ["easy", EASY, 1200],
    ["hard", HARD, 800],
  ])("of the %s level reaches the zone when it must", (_name, strip, wanted_ms) => {
    expect(flight_ms(strip)).toBe(wanted_ms);
    const { game, now_ms } = flying(strip);
    expect(lit_px(game, now_ms)).toBe(0);
    expect(lit_px(game, now_ms + wanted_ms - 0.01)).toBe(119);
    expect(lit_px(game, now_ms + wanted_ms + 0.01)).toBe(120);
    expect(lit_px(game, now_ms + 5000)).toBeNull();
  });

  it("waits a time that is drawn by lot, within its bounds", () => {
    for (const luck of [0, 0.5, 0.999]) {
      const { now_ms } = until(newGame(EASY, 1), 1000, (game) => game.phase === "fly", luck);
      expect(now_ms - 1000).toBeGreaterThanOrEqual(500 + 700 * luck);
      expect(now_ms - 1000).toBeLessThan(500 + 700 * luck + FRAME_ms + 0.01);
    }
  });

  it("is reported with the time at which its first picture was drawn", () => {
    const start = flying();
    let game = pressed(start.game, { at_ms: start.now_ms + 1190, hand: "mouse" });
    ({ game } = until(game, start.now_ms, (one) => one.phase === "keep"));
    expect(round(game)).toEqual({
      number: 1,
      start_ms: start.now_ms,
      target_ms: start.now_ms + 1200,
      end_ms: start.now_ms + 1440 + 450,
      hand: "mouse",
    });
  });

  it("hears the hand only while the bullet flies and shortly after", () => {
    const waiting = newGame(EASY, 1);
    expect(listens(waiting)).toBe(false);
    expect(pressed(waiting, { at_ms: 5, hand: "key" })).toBe(waiting);
    const { game, now_ms } = flying();
    expect(listens(game)).toBe(true);
    const after = until(game, now_ms, (one) => one.phase === "after");
    expect(listens(after.game)).toBe(true);
    expect(lit_px(after.game, after.now_ms)).toBeNull();
    const late = until(after.game, after.now_ms, (one) => one.phase === "keep").game;
    expect(listens(late)).toBe(false);
  });

  it("is followed by the next one only once it is kept, and the last by none", () => {
    let { game, now_ms } = flying();
    ({ game, now_ms } = until(game, now_ms, (one) => one.phase === "keep"));
    expect(drawn(game, now_ms + 60_000, 0)).toBe(game);
    expect(kept(game, 2)).toBe(game);
    game = kept(game, 1);
    expect([game.phase, game.kept, game.presses.length]).toEqual(["wait", 1, 0]);
    ({ game } = until(game, now_ms, (one) => one.phase === "keep"));
    expect(kept(game, 2).phase).toBe("over");
    expect(drawn(kept(game, 2), 1e9, 0).phase).toBe("over");
  });
});

describe("a pause", () => {
  it("has the bullet that was under way flown again", () => {
    const { game, now_ms } = flying();
    const still = paused(pressed(game, { at_ms: now_ms, hand: "key" }));
    expect([still.phase, still.presses.length, still.kept]).toEqual(["pause", 0, 0]);
    expect(drawn(still, now_ms + 9000, 0)).toBe(still);
    const again = resumed(still);
    expect([again.phase, again.from_ms]).toEqual(["wait", null]);
    expect(round(still)).toBeNull();
  });

  it("waits for a round that is being kept", () => {
    const { game, now_ms } = flying();
    const keeping = until(game, now_ms, (one) => one.phase === "keep").game;
    expect(paused(keeping)).toBe(keeping);
  });
});
