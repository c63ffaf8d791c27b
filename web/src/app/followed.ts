/** Something the server knows, asked anew whenever it may have changed. */

import { StudioError } from "../net";
import { type Signal, signal, tell } from "../ui";

export class Followed<Detail> {
  /** The latest answer; null before the first. */
  readonly detail: Signal<Detail | null> = signal<Detail | null>(null);
  /** Why it cannot be shown at all; empty if it can. */
  readonly wrong: Signal<string> = signal("");
  private asking: Promise<void> | null = null;
  private next: Promise<void> | null = null;

  constructor(private readonly ask: () => Promise<Detail>) {}

  /** Ask anew, and wait for the answer; asks that come while one is under way are one, after it. */
  refresh(): Promise<void> {
    if (!this.asking) return this.begin();
    this.next ??= this.asking.then(() => this.begin());
    return this.next;
  }

  /** Know it anew once something was done to it. */
  async after(done: Promise<unknown>): Promise<void> {
    await done;
    await this.refresh();
  }

  private begin(): Promise<void> {
    this.next = null;
    this.asking = this.askAnew();
    return this.asking;
  }

  private async askAnew(): Promise<void> {
    try {
      this.detail.set(await this.ask());
      this.wrong.set("");
    } catch (error) {
      // what the person cannot change is said in the page, the rest beside it
      if (error instanceof StudioError && !this.detail.peek()) this.wrong.set(error.message);
      else tell(error);
    } finally {
      if (!this.next) this.asking = null;
    }
  }
}
