/** Work that a person waits for, one at a time. */

import { tell } from "./toast";

export class Busy {
  private working = $state(false);

  /** wrong: shows why the work failed; a notice unless a component has a better place. */
  constructor(private readonly wrong: (error: unknown) => void = tell) {}

  /** Whether work is under way; a component follows it. */
  get on(): boolean {
    return this.working;
  }

  /** Do something, unless something is under way already; what it throws is shown. */
  async run(work: () => Promise<unknown>): Promise<void> {
    if (this.working) return;
    this.working = true;
    try {
      await work();
    } catch (error) {
      this.wrong(error);
    } finally {
      this.working = false;
    }
  }
}
