/** One study as the operator may know it, followed while the page is open. */

import { call, live, type LiveChannel, StudioError } from "../../net";
import type { StudiesDetail } from "../../net/messages";
import { onCleanup, signal, tell, type Signal } from "../../ui";

export class StudyStore {
  readonly detail: Signal<StudiesDetail | null> = signal<StudiesDetail | null>(null);
  readonly wrong: Signal<string> = signal("");
  private asking = false;
  private again = false;

  constructor(readonly study: string) {
    watchStudies((changed) => (changed === null || changed === study) && void this.refresh());
    void this.refresh();
  }

  /** Ask anew; asks that come meanwhile are one. */
  async refresh(): Promise<void> {
    this.again = true;
    if (this.asking) return;
    this.asking = true;
    try {
      while (this.again) {
        this.again = false;
        this.detail.set(await call("studies.detail", { study: this.study }));
        this.wrong.set("");
      }
    } catch (error) {
      if (error instanceof StudioError && !this.detail.peek()) this.wrong.set(error.message);
      else tell(error);
    } finally {
      this.asking = false;
    }
  }

  /** Do something that answers with the study as it is then. True if it was done. */
  async act(work: () => Promise<StudiesDetail>): Promise<boolean> {
    try {
      this.detail.set(await work());
      return true;
    } catch (error) {
      tell(error);
      return false;
    }
  }
}

/** Hear of changes until the page goes. changed : a study's name, or null where any may have. */
export function watchStudies(changed: (study: string | null) => void): void {
  let channel: LiveChannel<"studies"> | null = null;
  const watch = () => void channel?.send({ type: "watch" });
  channel = live().channel("studies", { opened: watch, told: (news) => changed(news.type === "changed" ? news.study : null) });
  watch();
  onCleanup(() => channel.close());
}
