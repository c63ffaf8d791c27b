/** Tapping, second by second. */

import { describe, expect, it } from "vitest";
import {
  newTapping,
  SETTLE_ms,
  secondOver,
  secondsLeft,
  type TapRound,
  tappedAt,
  taps,
} from "../../src/play/tapping";

describe("seconds of tapping", () => {
  it("begin with the first tap, and every tap until their end counts", () => {
    const waiting = newTapping(3);
    expect(secondOver(waiting, 1e9)).toBeNull();
    expect([taps(waiting, 5), secondsLeft(waiting, 1e9)]).toEqual([true, 3]);
    const now = tappedAt(tappedAt(waiting, 1000), 1100);
    expect(now.from_ms).toBe(1000);
    expect([taps(now, 3999), taps(now, 4000)]).toEqual([true, false]);
    expect([1001, 2000, 3999, 9000].map((at) => secondsLeft(now, at))).toEqual([3, 2, 1, 0]);
  });

  it("are sent one after the other, without a gap and each once", () => {
    let now = tappedAt(newTapping(3), 1000);
    const sent: TapRound[] = [];
    for (let at = 1000; at < 6000; at += 16) {
      const found = secondOver(now, at);
      if (!found) continue;
      sent.push(found[0]);
      now = found[1];
      expect(at).toBeGreaterThanOrEqual(found[0].end_ms + SETTLE_ms);
    }
    expect(sent.map((one) => [one.number, one.start_ms])).toEqual([
      [1, 1000],
      [2, 2000],
      [3, 3000],
    ]);
    for (const [at, one] of sent.entries()) {
      // a tap belongs to one second only
      expect(one.end_ms).toBeLessThan(sent[at + 1]?.start_ms ?? 4000);
      expect(one.end_ms).toBeGreaterThan(one.start_ms + 999.9);
    }
  });
});
