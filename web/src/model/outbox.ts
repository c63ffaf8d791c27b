/** Changes on their way to the server: one after the other, tried again until they are answered. */

import type { Change, Doing, Surroundings } from "./server";

/** Pauses between tries; the last one repeats. */
const AGAIN_ms = [300, 1000, 2000, 5000] as const;

/** What came of sending one change: it is kept, the server was out of reach, or a person must decide first. */
export type Sent = "kept" | "lost" | "stopped";

/** A line of changes that loses none. */
export class Outbox {
  #queue: Change[] = [];
  #sending: Promise<void> | null = null;
  #hurried = false;
  #wake: () => void = () => undefined;

  /**
   * post : sends one change, and takes it out if it is kept. stopped : whether nothing may be sent now.
   * emptied : runs when all is sent, or stopped.
   */
  constructor(
    private readonly around: Surroundings,
    private readonly post: (change: Change) => Promise<Sent>,
    private readonly stopped: () => boolean,
    private readonly emptied: () => Promise<void>,
  ) {}

  /** How many changes are not kept yet. */
  get size(): number {
    return this.#queue.length;
  }

  add(doing: Doing): void {
    this.#queue.push({ ...doing, change_id: this.around.newId() });
  }

  /** Take a change out that the server has; false if it was dropped before. */
  taken(change: Change): boolean {
    const there = this.#queue[0] === change;
    if (there) this.#queue.shift();
    return there;
  }

  /** Begin to send, if that is not under way. */
  start(): void {
    this.#sending ??= this.#drain();
  }

  /** Try at once what waits for its next try: the server is said to be there again. */
  hurry(): void {
    this.#hurried = true;
    this.#wake();
  }

  /** Drop what is not kept yet. */
  clear(): void {
    this.#queue = [];
  }

  /** Wait until nothing is on its way. */
  async settled(): Promise<void> {
    while (this.#sending) await this.#sending;
  }

  async #drain(): Promise<void> {
    do {
      for (let tries = 0; this.#queue.length && !this.stopped(); ) {
        this.#hurried = false;
        const sent = await this.post(this.#queue[0]!);
        tries = sent === "lost" ? tries + 1 : 0;
        if (tries) await this.#pause(AGAIN_ms[Math.min(tries, AGAIN_ms.length) - 1]!);
      }
      await this.emptied();
      // a change that was made meanwhile has to be sent as well
    } while (this.#queue.length && !this.stopped());
    this.#sending = null;
  }

  async #pause(ms: number): Promise<void> {
    if (this.#hurried) return;
    const woken = new Promise<void>((resolve) => {
      this.#wake = resolve;
    });
    await Promise.race([this.around.wait(ms), woken]);
  }
}
