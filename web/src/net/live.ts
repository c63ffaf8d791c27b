/** The one live connection: channels over it, opened again when it is lost. */

import { type Signal, signal } from "../ui/signal.svelte";
import type { Channels } from "./messages";

export type LiveState = "opening" | "open" | "lost";

export interface Listener<K extends keyof Channels> {
  readonly onMessage: (message: Channels[K]["tells"]) => void;
  /** One line that the server says of this channel. */
  readonly wrong?: (line: string) => void;
  /** The connection is there, for the first time or again: ask for what is wanted now. */
  readonly opened?: (channel: LiveChannel<K>) => void;
  readonly lost?: () => void;
}

export interface LiveChannel<K extends keyof Channels> {
  /** Send; false if there is no connection, and then nothing was sent. */
  send(ask: Channels[K]["asks"]): boolean;
  close(): void;
}

interface Heard<K extends keyof Channels> {
  readonly listener: Listener<K>;
  readonly channel: LiveChannel<K>;
}

interface Envelope {
  readonly channel: string;
  readonly body?: unknown;
  readonly error?: string;
}

const AGAIN_ms = [200, 500, 1000, 2000, 5000] as const;

export class Live {
  readonly state: Signal<LiveState> = signal<LiveState>("opening");
  private socket: WebSocket | null = null;
  private tries = 0;
  private readonly heard = new Map<string, Set<Heard<never>>>();

  constructor(private readonly address: string) {}

  /** Begin; called once by the shell. */
  open(): void {
    const socket = new WebSocket(this.address);
    this.socket = socket;
    socket.onopen = () => {
      this.tries = 0;
      this.state.set("open");
      this.each(({ listener, channel }) => listener.opened?.(channel));
    };
    socket.onmessage = (event) => this.take(JSON.parse(event.data as string) as Envelope);
    socket.onclose = () => this.again();
  }

  /** Listen to a channel until it is closed. */
  channel<K extends keyof Channels>(name: K, listener: Listener<K>): LiveChannel<K> {
    const set = this.heard.get(name) ?? new Set();
    this.heard.set(name, set);
    const channel: LiveChannel<K> = {
      send: (ask) => this.send(name, ask),
      close: () => set.delete(heard),
    };
    const heard = { listener, channel } as unknown as Heard<never>;
    set.add(heard);
    if (this.state.peek() === "open") listener.opened?.(channel);
    return channel;
  }

  private send(channel: string, body: unknown): boolean {
    if (this.socket?.readyState !== WebSocket.OPEN) return false;
    this.socket.send(JSON.stringify({ channel, body }));
    return true;
  }

  private take(envelope: Envelope): void {
    for (const { listener } of [...(this.heard.get(envelope.channel) ?? [])]) {
      if (envelope.error !== undefined) listener.wrong?.(envelope.error);
      else (listener.onMessage as (message: unknown) => void)(envelope.body);
    }
  }

  private again(): void {
    const wait = AGAIN_ms[Math.min(this.tries++, AGAIN_ms.length - 1)] as number;
    if (this.state.peek() !== "lost") this.each(({ listener }) => listener.lost?.());
    this.state.set("lost");
    setTimeout(() => this.open(), wait);
  }

  private each(work: (heard: Heard<never>) => void): void {
    for (const set of this.heard.values()) for (const heard of [...set]) work(heard);
  }
}

const SEAT = "fdvv-seat";
let word: string | null = null;

/** The word of the seat that this page is confined to; empty on the studio's own page.
 *
 * It is taken out of the address at once, so that it is not in the history, and kept in this tab for a reload. */
export function seat(): string {
  const asked = new URLSearchParams(location.search).get("seat");
  if (asked !== null) {
    sessionStorage.setItem(SEAT, asked);
    history.replaceState(null, "", location.pathname + location.hash);
  }
  word ??= location.hash.startsWith("#/study/") ? (sessionStorage.getItem(SEAT) ?? "") : "";
  return word;
}

let page: Live | null = null;

/** Return the page's one connection. */
export function live(): Live {
  const asked = seat() ? `?${new URLSearchParams({ seat: seat() })}` : "";
  page ??= new Live(`${location.protocol === "https:" ? "wss" : "ws"}://${location.host}/live${asked}`);
  return page;
}
