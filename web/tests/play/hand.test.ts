/** Which presses a task hears. */

// @vitest-environment jsdom
import { afterEach, describe, expect, it } from "vitest";
import type { InputDevice } from "../../src/play/game";
import { followKey, type Played, SPACE_BAR } from "../../src/play/hand";
import { scope } from "../../src/ui";

class Heard implements Played {
  playing_ = true;
  readonly downs: [number, InputDevice][] = [];
  readonly ups: number[] = [];
  playing(): boolean {
    return this.playing_;
  }
  press(at_ms: number, hand: InputDevice): void {
    this.downs.push([at_ms, hand]);
  }
  release(at_ms: number): void {
    this.ups.push(at_ms);
  }
}

let end = () => {};
afterEach(() => end());

function hearing(counts: (event: KeyboardEvent) => boolean): { heard: Heard; others: string[] } {
  const heard = new Heard();
  const others: string[] = [];
  end = scope(() => followKey(heard, counts, (event) => others.push(event.code)));
  return { heard, others };
}

function key(type: "keydown" | "keyup", more: KeyboardEventInit): KeyboardEvent {
  const event = new KeyboardEvent(type, { bubbles: true, cancelable: true, ...more });
  document.body.dispatchEvent(event);
  return event;
}

describe("a key", () => {
  it("counts once, at the time of its event, however long it repeats", () => {
    const { heard } = hearing((event) => event.code === "F13");
    const first = key("keydown", { code: "F13" });
    key("keydown", { code: "F13", repeat: true });
    const last = key("keyup", { code: "F13" });
    expect(heard.downs).toEqual([[first.timeStamp, "key"]]);
    expect(heard.ups).toEqual([last.timeStamp]);
    expect([first.defaultPrevented, last.defaultPrevented]).toEqual([true, true]);
  });

  it("is none while nothing is played, and does then what it always does", () => {
    const { heard } = hearing(SPACE_BAR);
    heard.playing_ = false;
    expect(key("keydown", { key: " ", code: "Space" }).defaultPrevented).toBe(false);
    expect(heard.downs).toEqual([]);
  });

  it("that does not count is reported as another, and one with a modifier is none", () => {
    const { heard, others } = hearing((event) => event.code === "F13");
    key("keydown", { code: "Space" });
    key("keydown", { code: "F13", ctrlKey: true });
    expect([heard.downs, others]).toEqual([[], ["Space"]]);
  });

  it("is let go where the window loses it", () => {
    const { heard } = hearing(SPACE_BAR);
    dispatchEvent(new Event("blur"));
    expect(heard.ups).toHaveLength(1);
  });
});
