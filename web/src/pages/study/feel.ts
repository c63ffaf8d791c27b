/** What is under the finger: how it is drawn, its click, and hands that press it. No force is drawn. */

import { onCleanup } from "../../ui";
import { stageScale } from "../press/drawing";
import { FingerInput } from "../press/finger_input";
import { Clicker } from "../press/sound";
import type { StudySession } from "./session";

/** How fast the space bar presses, and with what push at the bottom. */
const SPEED_mm_s = 120;
const PUSH_cN = 120;
const LIFTED_mm = -2;
const TOUCHED_mm = 0.02;
const TRAVEL_mm = 4;

/** The hands and ears of one trial; ends with its scope. */
export class Feeling {
  private readonly clicker = new Clicker();
  private readonly hands: FingerInput;

  constructor(private readonly session: StudySession) {
    this.hands = new FingerInput(session, {
      speed_mm_s: () => SPEED_mm_s,
      push_cN: () => PUSH_cN,
      used: () => this.clicker.wake(),
    });
    const view = this.listener();
    session.view = view;
    onCleanup(() => {
      // the next trial may be shown by now
      if (session.view === view) session.view = null;
      this.clicker.close();
    });
  }

  /** Have pointers on the element press, and keys wherever the focus is, until the scope of the call ends. */
  follow(element: HTMLElement): void {
    const scale = () => stageScale(this.session.travel_mm() ?? TRAVEL_mm, element.clientHeight);
    this.hands.onPointer(element, scale, () => this.session.frame.peek()?.displacement_mm ?? 0);
    this.hands.onKeys();
  }

  /** What is drawn; null while nothing is under the finger. */
  see() {
    const { session } = this;
    const ready = session.ready();
    if (!ready || session.onTable() || !session.felt() || session.going()) return null;
    const aim_mm = this.hands.aim_mm();
    const cap_mm = session.frame()?.displacement_mm ?? 0;
    const frame = {
      displacement_mm: [cap_mm],
      finger_mm: [cap_mm > TOUCHED_mm ? cap_mm : Math.min(0, aim_mm ?? LIFTED_mm)],
      force_cN: [],
      key: session.frame()?.key ? 1 : 0,
    };
    return { ready: { travel_mm: ready.travel_mm, places: [] }, frame, aim_mm, blind: true };
  }

  private listener(): NonNullable<StudySession["view"]> {
    return {
      onReady: (ready) => this.clicker.load(ready.signals),
      onFelt: () => this.hands.lift(performance.now()),
      onFrame: (frame) => {
        this.clicker.follow(frame.t_s + frame.dropped_s);
        for (const click of frame.clicks)
          this.clicker.click(click.sound, click.t_s + frame.dropped_s, click.velocity_mm_s);
      },
    };
  }
}
