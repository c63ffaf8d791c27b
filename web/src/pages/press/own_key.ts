/** A key of the person's keyboard at the press page: it leads the finger, and triggers as it is set. */

import { analogKey } from "../../keyboard/analog_key";
import type { Sample } from "../../keyboard/depths";
import { newest } from "../../keyboard/newest";
import {
  type Actuations,
  changed,
  counted,
  DEFAULTS,
  moved,
  NONE,
  RESTING,
  type TriggerSettings,
  type TriggerState,
} from "../../keyboard/trigger";
import { effect, onCleanup, type Signal, signal, untracked } from "../../ui";
import { Latency } from "./latency";
import type { PressStage } from "./stage";

/** The simulation moves in steps of so much; more would only wait there. */
const LEADS_ms = 4;
const SETTINGS = "fdvv-key-trigger";

/** When the key went down or up by the trigger. */
export interface TriggerEvent {
  readonly t_ms: number;
  readonly down: boolean;
}
const KEPT = 200;

/** Make one in a component or scope. */
export class OwnKey {
  readonly settings: Signal<TriggerSettings> = signal(remembered());
  /** Of the key by the settings; changes with the readings. */
  readonly down: Signal<boolean> = signal(false);
  readonly actuations: Signal<Actuations> = signal(NONE);
  readonly latency = new Latency();
  state: TriggerState = RESTING;
  events: TriggerEvent[] = [];
  /** Called with each reading. */
  onRead: () => void = () => undefined;
  private sequence = 0;
  private was_mm = 0;
  private readonly lead: (sample: Sample) => void;

  constructor(stage: PressStage) {
    this.lead = newest<Sample>(LEADS_ms, ({ depth_mm, velocity_mm_s, t_ms }) =>
      stage.hands.follow(depth_mm, velocity_mm_s, t_ms),
    );
    // the finger rests on the cap before the key moves, else it would fall on it
    effect(() => {
      if (["live", "playing"].includes(analogKey.status()))
        untracked(() => stage.hands.follow(0, 0, performance.now()));
    });
    const unfollow = analogKey.follow((sample) => this.read(sample));
    onCleanup(() => {
      unfollow();
      if (stage.hands.how.peek() === "travel") stage.hands.lift(performance.now());
    });
  }

  /** Change settings; the trigger begins anew with the next reading. */
  set(by: Partial<TriggerSettings>): void {
    this.settings.update((now) => changed(now, by));
    this.state = RESTING;
    localStorage.setItem(SETTINGS, JSON.stringify(this.settings.peek()));
  }

  count(): void {
    this.actuations.set(NONE);
  }

  /** A frame was drawn that shows the last reading. */
  drawn(): void {
    this.latency.drawn(this.sequence, performance.now());
  }

  private read(sample: Sample): void {
    // what is not looked at is not drawn
    if (!document.hidden) this.latency.sent(++this.sequence, sample.t_ms);
    this.trigger(sample);
    // a key that rests leaves the finger to mouse and keys
    if (!document.hidden && (sample.depth_mm > 0 || this.was_mm > 0)) this.lead(sample);
    this.was_mm = sample.depth_mm;
    this.onRead();
  }

  private trigger({ t_ms, depth_mm }: Sample): void {
    this.state = moved(this.state, depth_mm, this.settings.peek());
    const { down } = this.state;
    if (down === this.down.peek()) return;
    this.down.set(down);
    this.actuations.update((all) => counted(all, down, t_ms));
    this.events = [...this.events, { t_ms, down }].slice(-KEPT);
  }
}

function remembered(): TriggerSettings {
  try {
    const found = JSON.parse(localStorage.getItem(SETTINGS) ?? "{}") as Partial<TriggerSettings>;
    const numbers = Object.entries(found).filter(
      ([name, value]) => typeof value === typeof DEFAULTS[name as keyof TriggerSettings],
    );
    return changed(DEFAULTS, Object.fromEntries(numbers));
  } catch {
    return DEFAULTS;
  }
}
