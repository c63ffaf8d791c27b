/** The participant's screen of a timing study, against a server that says what the contract says. */

// @vitest-environment jsdom
import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";
import type { Channels, TimingStepMessage, TimingTrial } from "../../../src/net/messages";
import type { TimingSession } from "../../../src/pages/study/timing/session";
import { keyText, timingWord } from "../../../src/pages/study/timing/words";
import { scope } from "../../../src/ui";

type Ask = Channels["timing"]["asks"];
type Tell = Channels["timing"]["tells"];

const SWITCH: TimingTrial = {
  number: 4,
  phase: "validation",
  level: "easy",
  code: "K4",
  hand: "switch",
  switch: "MX Red",
  key: "F13",
  rounds: 2,
  kept: 0,
  at: 1,
  of: 3,
  strip: { pixels: 144, zone_px: 100, zone_half_px: 5, speed_px_s: 100 },
  tap_s: 0,
};
const READY = { type: "ready", number: 4, on: "table", attempt: 1, kept: 0, rounds: 2, signals: [] } as const;
const FRAME_ms = 1000 / 60;

/** The studio's end of the connection. */
class Server {
  asks: Ask[] = [];
  private socket: FakeSocket | null = null;

  open(socket: FakeSocket): void {
    this.socket = socket;
    socket.readyState = 1;
    socket.onopen?.();
  }
  tell(body: Tell): void {
    this.socket?.onmessage?.({ data: JSON.stringify({ channel: "timing", body }) });
  }
  lose(): void {
    const lost = this.socket;
    this.socket = null;
    if (lost) lost.readyState = 3;
    lost?.onclose?.();
  }
  of<K extends Ask["type"]>(type: K): Extract<Ask, { type: K }>[] {
    return this.asks.filter((ask): ask is Extract<Ask, { type: K }> => ask.type === type);
  }
}
let server = new Server();

class FakeSocket {
  static readonly OPEN = 1;
  readyState = 0;
  onopen: (() => void) | null = null;
  onclose: (() => void) | null = null;
  onmessage: ((event: { data: string }) => void) | null = null;
  constructor(readonly address: string) {
    setTimeout(() => server.open(this), 0);
  }
  send(text: string): void {
    server.asks.push((JSON.parse(text) as { body: Ask }).body);
  }
}

let session: TimingSession;
let end = () => {};
let now_ms = 0;
const step = (kind: TimingStepMessage["kind"], trial: TimingTrial | null): Tell => ({
  type: "step",
  kind,
  progress_ratio: 0.5,
  form: null,
  trial,
  left_s: null,
  due_at: "",
});

/** Let time pass, picture by picture. */
function pass(time_ms: number): void {
  for (const until = now_ms + time_ms; now_ms < until; ) {
    now_ms += FRAME_ms;
    vi.advanceTimersByTime(FRAME_ms);
  }
}

beforeEach(async () => {
  vi.useFakeTimers();
  vi.resetModules();
  now_ms = 0;
  server = new Server();
  vi.stubGlobal("WebSocket", FakeSocket);
  vi.stubGlobal(
    "ResizeObserver",
    class {
      observe() {}
      disconnect() {}
    },
  );
  vi.stubGlobal("matchMedia", () => ({ matches: false, addEventListener() {}, removeEventListener() {} }));
  HTMLCanvasElement.prototype.getContext = () => null;
  sessionStorage.clear();
  const { live } = await import("../../../src/net");
  const { TimingSession: Made } = await import("../../../src/pages/study/timing/session");
  live().open();
  vi.advanceTimersByTime(1);
  end = scope(() => {
    session = new Made("mine", "");
  });
  session.clicker.muted = true;
  server.tell({ type: "card", person: "P01", language: "en", code: "ABCD" });
  server.tell(step("trial", SWITCH));
  session.noted();
});
afterEach(() => {
  end();
  vi.useRealTimers();
  vi.unstubAllGlobals();
});

function begun(): void {
  session.start();
  expect(server.of("begin")).toEqual([{ type: "begin", number: 4 }]);
  server.tell(READY);
  expect(session.status()).toBe("there");
}

/** Let a bullet fly past, pressing at a time after it started. */
function flown(press_ms: number | null): void {
  for (let at = 0; session.player.game()?.phase !== "fly" && at < 200; at++) pass(FRAME_ms);
  const from_ms = session.player.game()?.from_ms ?? 0;
  if (press_ms !== null) {
    pass(press_ms);
    session.press(from_ms + press_ms, "key");
    session.release(from_ms + press_ms + 80);
  }
  for (let at = 0; session.player.game()?.phase !== "keep" && at < 400; at++) pass(FRAME_ms);
}

describe("a trial on a switch", () => {
  it("sends each press with the time of its event, and the round that it is in", () => {
    begun();
    flown(990);
    const [down] = server.of("down");
    const [over] = server.of("round");
    expect(over?.number).toBe(1);
    expect(over?.target_ms).toBeCloseTo((over?.start_ms ?? 0) + 1000, 6);
    expect(down?.at_ms).toBeCloseTo((over?.start_ms ?? 0) + 990, 6);
    expect(over?.hand).toBe("key");
  });

  it("counts a round only once the server has it on its disk", () => {
    begun();
    flown(990);
    pass(5000);
    expect([session.kept(), server.of("round").length]).toEqual([0, 1]);
    server.tell({ type: "kept", number: 1, transport_ms: null, finished: false });
    expect(session.kept()).toBe(1);
    flown(null);
    expect(server.of("round").map((one) => one.number)).toEqual([1, 2]);
  });

  it("that was broken off goes on at its next round, once the study is back", () => {
    begun();
    flown(990);
    server.tell({ type: "kept", number: 1, transport_ms: null, finished: false });
    server.lose();
    expect([session.status(), session.lost(), session.playing()]).toEqual(["away", true, false]);
    pass(1000);
    expect(server.of("resume")).toEqual([{ type: "resume", study: "mine", person: "P01", code: "ABCD" }]);
    // the connection is back before the study is
    expect(session.lost()).toBe(true);
    server.tell(step("trial", { ...SWITCH, kept: 1 }));
    expect([session.lost(), session.kept()]).toEqual([false, 1]);
    session.start();
    server.tell({ ...READY, attempt: 2, kept: 1 });
    flown(990);
    expect(server.of("round").map((one) => one.number)).toEqual([1, 2]);
  });

  it("is no miss where the page was hidden or lost the keys: that bullet flies again", () => {
    begun();
    for (let at = 0; session.player.game()?.phase !== "fly" && at < 200; at++) pass(FRAME_ms);
    dispatchEvent(new Event("blur"));
    pass(5000);
    expect([session.resting(), server.of("round").length]).toEqual([true, 0]);
    session.goOn();
    flown(990);
    expect(server.of("round")).toHaveLength(1);
  });

  it("stops while the operator pauses", () => {
    begun();
    server.tell({ type: "paused", on: true });
    expect([session.playing(), session.covered(), session.resting()]).toEqual([false, true, true]);
    server.tell({ type: "paused", on: false });
    expect([session.covered(), session.resting()]).toEqual([false, true]);
  });

  it("is put under the finger again where the button was lost", () => {
    begun();
    server.tell({ type: "broke" });
    expect(session.status()).toBe("opening");
    expect(server.of("begin")).toHaveLength(2);
  });

  it("asks for the server's clock while it lasts, and not before", () => {
    pass(1000);
    expect(server.of("ping")).toEqual([]);
    begun();
    pass(1000);
    expect(server.of("ping").length).toBeGreaterThanOrEqual(4);
  });
});

describe("tapping", () => {
  it("tells every second, without a target, and is begun anew after a stop", () => {
    server.tell(step("trial", { ...SWITCH, strip: null, tap_s: 3, rounds: 3 }));
    session.start();
    server.tell({ ...READY, rounds: 3 });
    pass(500);
    for (let at = 0; at < 20; at++) {
      session.press(performance.now(), "key");
      session.release(performance.now() + 50);
      pass(200);
    }
    expect(server.of("round").map((one) => [one.number, one.target_ms])).toEqual([
      [1, null],
      [2, null],
      [3, null],
    ]);
    // taps after the time is over are none
    expect(server.of("down")).toHaveLength(15);
    session.pause();
    expect(session.resting()).toBe(true);
    session.goOn();
    expect(server.of("begin")).toHaveLength(2);
  });
});

describe("words", () => {
  it.each(["en", "de", "fi", "fr", "zh"])(
    "of %s name what lies on the table and the key that counts",
    (language) => {
      for (const which of ["placeSwitch", "placeKey"] as const)
        expect(timingWord(language, which, { switch: "MX Red" })).toContain("MX Red");
      expect(timingWord(language, "other", { key: "F13" })).toContain("F13");
      expect(timingWord(language, "waitText", { date: "|" })).toContain("|");
      expect(keyText(language, "Space")).not.toBe("Space");
      if (language !== "en") expect(timingWord(language, "point")).not.toBe(timingWord("en", "point"));
    },
  );

  it("name keys as they are printed", () => {
    expect(["F13", "KeyA", "Digit4", "NumpadEnter"].map((code) => keyText("en", code))).toEqual([
      "F13",
      "A",
      "4",
      "Numpad Enter",
    ]);
  });
});
