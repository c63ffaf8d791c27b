/** One study as the operator may know it, followed while the page is open. */

import { Followed } from "../../app/followed";
import { call, live } from "../../net";
import type { StudiesDetail, StudiesStanding, TimingPerson } from "../../net/messages";
import { onCleanup, type Signal, signal } from "../../ui";

const TIMED: readonly string[] = ["timing", "tapping"];

export class StudyStore extends Followed<StudiesDetail> {
  /** Whether the text of the plan has changes that are not kept. */
  readonly changed: Signal<boolean> = signal(false);
  /** Whether the dialog that freezes is open. */
  readonly freezing: Signal<boolean> = signal(false);
  /** How far it is, in a sentence. */
  readonly standing: Signal<StudiesStanding | null> = signal<StudiesStanding | null>(null);

  /** Of a timing study: how far each person is, by name. */
  readonly progress: Signal<ReadonlyMap<string, TimingPerson>> = signal<ReadonlyMap<string, TimingPerson>>(
    new Map(),
  );

  constructor(readonly study: string) {
    super(async () => {
      const [detail, standing] = await Promise.all([
        call("studies.detail", { study }),
        call("studies.standing", { study }),
      ]);
      this.standing.set(standing);
      if (TIMED.includes(detail.row.kind) && detail.row.state !== "draft") {
        const { people } = await call("timing.progress", { study });
        this.progress.set(new Map(people.map((one) => [one.person, one])));
      }
      return detail;
    });
    watchStudies((changed) => (changed === null || changed === study) && void this.refresh());
    void this.refresh();
  }
}

/** Hear of changes until the page goes. changed : a study's name, or null where any may have. */
export function watchStudies(changed: (study: string | null) => void): void {
  const channel = live().channel("studies", {
    opened: (channel) => void channel.send({ type: "watch" }),
    onMessage: (news) => changed(news.type === "changed" ? news.study : null),
  });
  onCleanup(() => channel.close());
}
