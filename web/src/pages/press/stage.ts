/** A button to press: what leads the finger, the session, the click. `Stage.svelte` shows it on any page. */

import { onCleanup, type Signal, signal } from "../../ui";
import { stageScale } from "./drawing";
import { FingerInput } from "./finger_input";
import { type Choice, PressSession } from "./session";
import { Clicker } from "./sound";

/** Make one in a component or scope, whose end takes everything away. */
export class PressStage {
  readonly session = new PressSession();
  readonly clicker = new Clicker();
  readonly speed_mm_s: Signal<number> = signal(120);
  /** With what push the space bar presses. */
  readonly push_cN: Signal<number>;
  readonly hands: FingerInput;

  constructor(push_cN = 120) {
    this.push_cN = signal(push_cN);
    const used = () => this.clicker.wake();
    this.hands = new FingerInput(this.session, { speed_mm_s: this.speed_mm_s, push_cN: this.push_cN, used });
    this.hear();
    onCleanup(() => this.clicker.close());
  }

  /** Put something under the finger; what leads the finger goes on leading it. */
  start(choice: Choice): void {
    this.session.start(choice);
  }

  /** What is drawn now; follows signals. */
  see() {
    const ready = this.session.ready();
    return ready && { ready, frame: this.session.frame(), aim_mm: this.hands.aim_mm() };
  }

  /** It was drawn. */
  drawn(): void {
    const frame = this.session.frame.peek();
    if (frame) this.session.latency.drawn(frame.sequence, performance.now());
  }

  /** Have pointers on the drawing press, and keys wherever the focus is, until the scope of the call ends. */
  follow(view: HTMLElement): void {
    const scale = () => stageScale(this.session.travel_mm() ?? 4, view.clientHeight);
    this.hands.onPointer(view, scale, () => this.session.frame.peek()?.displacement_mm.at(-1) ?? 0);
    this.hands.onKeys();
  }

  private hear(): void {
    const { session, clicker, hands } = this;
    session.onReady = (ready) => {
      clicker.load(ready.signals);
      hands.resume();
    };
    session.onFrame = (frame) => {
      // time that was dropped has passed for the ear all the same
      clicker.follow(session.rows.now_s() + frame.dropped_s);
      for (const event of frame.events)
        if (event.kind === "vibration")
          clicker.click(event.number, event.t_s + frame.dropped_s, event.velocity_mm_s);
    };
  }
}
