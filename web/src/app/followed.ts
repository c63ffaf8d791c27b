/** Something the server knows, asked anew whenever it may have changed. */

import { StudioError } from "../net";
import { type Signal, signal, tell } from "../ui";

export class Followed<Detail> {
  /** The latest answer; null before the first. */
  readonly detail: Signal<Detail | null> = signal<Detail | null>(null);
  /** Why it cannot be shown at all; empty if it can. */
  readonly wrong: Signal<string> = signal("");
  private asking = false;
  private again = false;

  constructor(private readonly ask: () => Promise<Detail>) {}

  /** Ask anew; asks that come meanwhile are one. */
  async refresh(): Promise<void> {
    this.again = true;
    if (this.asking) return;
    this.asking = true;
    try {
      while (this.again) {
        this.again = false;
        this.detail.set(await this.ask());
        this.wrong.set("");
      }
    } catch (error) {
      // what the person cannot change is said in the page, the rest beside it
      if (error instanceof StudioError && !this.detail.peek()) this.wrong.set(error.message);
      else tell(error);
    } finally {
      this.asking = false;
    }
  }
}
