// @vitest-environment jsdom
import { afterEach, beforeEach, expect, it, vi } from "vitest";
import { Live } from "../../src/net/live";

/** A connection whose far end is the test. */
class Socket {
  static readonly OPEN = 1;
  static all: Socket[] = [];
  readyState = 0;
  readonly sent: unknown[] = [];
  onopen = () => {};
  onclose = () => {};
  onmessage = (_event: { readonly data: string }) => {};

  constructor() {
    Socket.all.push(this);
  }
  send(text: string): void {
    this.sent.push(JSON.parse(text));
  }
  open(): void {
    this.readyState = Socket.OPEN;
    this.onopen();
  }
  lose(): void {
    this.readyState = 3;
    this.onclose();
  }
  tell(channel: string, body: unknown): void {
    this.onmessage({ data: JSON.stringify({ channel, body }) });
  }
}

const WATCH = { channel: "studies", body: { type: "watch" } };

beforeEach(() => {
  Socket.all = [];
  vi.useFakeTimers();
  vi.stubGlobal("WebSocket", Socket);
});
afterEach(() => {
  vi.useRealTimers();
  vi.unstubAllGlobals();
});

/** Return an open connection and its first socket; who listens asks as soon as it can. */
function opened() {
  const live = new Live("ws://studio/live");
  live.open();
  return { live, socket: Socket.all[0] as Socket };
}

it("a channel asks once when the connection comes, and again when it comes back", () => {
  const { live, socket } = opened();
  const lost = vi.fn();
  live.channel("studies", {
    onMessage: vi.fn(),
    lost,
    opened: (channel) => void channel.send({ type: "watch" }),
  });
  expect(socket.sent).toEqual([]);
  socket.open();
  expect(socket.sent).toEqual([WATCH]);
  socket.lose();
  expect(lost).toHaveBeenCalledOnce();
  vi.advanceTimersByTime(1000);
  Socket.all[1]?.open();
  expect(Socket.all[1]?.sent).toEqual([WATCH]);
});

it("a channel of a connection that is there asks at once, and hears nothing after it is closed", () => {
  const { live, socket } = opened();
  socket.open();
  const onMessage = vi.fn();
  const channel = live.channel("studies", { onMessage, opened: (made) => void made.send({ type: "watch" }) });
  expect(socket.sent).toEqual([WATCH]);
  socket.tell("studies", { type: "watching" });
  socket.tell("jobs", { type: "jobs", jobs: [] });
  expect(onMessage.mock.calls).toEqual([[{ type: "watching" }]]);
  channel.close();
  socket.tell("studies", { type: "watching" });
  socket.lose();
  vi.advanceTimersByTime(1000);
  Socket.all[1]?.open();
  expect([onMessage.mock.calls.length, Socket.all[1]?.sent]).toEqual([1, []]);
});
