/** What leads the finger: pointer height, pressure, a hold that grows, keys, travel. All may be used at any time. */

import type { Scale } from "../../draw";
import { addShortcuts, onCleanup, type Signal, signal } from "../../ui";

/** The twin's finger gives way by so much, 450 N/m, and its pulp by some half a millimetre. */
const YIELD_mm_cN = 1 / 45;
const PULP_mm = 0.5;
const LIFTED_mm = -2;
/** A held button: how fast the push grows, and to what. */
const GROWS_cN_s = 220;
const MOST_cN = 320;
const FULL_PRESSURE_cN = 300;
const STEP_mm = 0.1;
/** Peak speed of a critically damped move is its length times its rate over e. */
const RATE_PER_SPEED = Math.E;

/** For the list of keys; what they do needs to know when a key comes up, so they are listened to here. */
const LISTED = [
  { keys: "Space, held", does: "Press the button", act: () => undefined },
  { keys: "↓ ↑", does: "Move the finger by 0.1 mm", act: () => undefined },
  { keys: "Escape, while pressing", does: "Lift the finger", act: () => undefined },
];

/** What hands lead: a session with a simulated finger. */
export interface FingerTarget {
  /** Of what is under the finger; null while nothing is. */
  travel_mm(): number | null;
  lead(referent_mm: number, velocity_mm_s: number, at_ms: number, near_1_s?: number): void;
  push(force_cN: number, at_ms: number): void;
  /** Have the cap go where a key of the person's keyboard is. */
  follow?(displacement_mm: number, velocity_mm_s: number, at_ms: number): void;
  lift(at_ms: number): void;
}

export interface HandOptions {
  /** How fast the space bar presses, mm/s, and with what push at the bottom, cN. */
  readonly speed_mm_s: () => number;
  readonly push_cN: () => number;
  /** The page is used: sound may begin. */
  readonly used: () => void;
}

export type How = "" | "height" | "pressure" | "hold" | "key" | "travel";

export class FingerInput {
  /** Where the finger is aimed at, mm; null where nothing leads it or a force does. */
  readonly aim_mm: Signal<number | null> = signal<number | null>(null);
  readonly how: Signal<How> = signal<How>("");
  private growing = 0;
  private again: ((at_ms: number) => void) | null = null;
  private held: { readonly at_ms: number; readonly mm: number } | null = null;

  constructor(
    private readonly session: FingerTarget,
    private readonly options: HandOptions,
  ) {
    onCleanup(() => cancelAnimationFrame(this.growing));
  }

  /** Follow a pointer on the stage. */
  onPointer(element: HTMLElement, scale: () => Scale, capTop_mm: () => number): void {
    const mm = (event: PointerEvent) => scale().value(event.clientY - element.getBoundingClientRect().top);
    element.addEventListener("pointerdown", (event) => {
      if (event.button !== 0) return;
      event.preventDefault();
      element.focus({ preventScroll: true });
      element.setPointerCapture(event.pointerId);
      this.options.used();
      if (hasPressure(event)) this.press(event);
      else if (mm(event) > capTop_mm()) this.hold(event.timeStamp);
      else this.height(mm(event), event.timeStamp);
    });
    element.addEventListener("pointermove", (event) => {
      if (!element.hasPointerCapture(event.pointerId)) return;
      if (hasPressure(event)) this.press(event);
      else if (this.how.peek() === "height") this.height(mm(event), event.timeStamp);
    });
    for (const end of ["pointerup", "pointercancel"] as const)
      element.addEventListener(
        end,
        (event) => element.hasPointerCapture(event.pointerId) && this.lift(event.timeStamp),
      );
  }

  /** Follow the space bar and the arrows wherever the page has the focus, unless something else uses them. */
  onKeys(): void {
    const down = (event: KeyboardEvent) => {
      if (
        event.defaultPrevented ||
        event.ctrlKey ||
        event.metaKey ||
        event.altKey ||
        taken(event.target, event.key)
      )
        return;
      if (event.key === " ") event.repeat || this.key(event.timeStamp);
      else if (event.key === "ArrowDown" || event.key === "ArrowUp")
        this.nudge(event.key === "ArrowDown" ? STEP_mm : -STEP_mm, event.timeStamp);
      else if (event.key === "Escape" && this.how.peek()) this.lift(event.timeStamp);
      else return;
      event.preventDefault();
      this.options.used();
    };
    const up = (event: KeyboardEvent) => {
      if (event.key === " " && this.how.peek() === "key") this.release(event.timeStamp);
    };
    const blur = () => this.how.peek() && this.lift(performance.now());
    addShortcuts(...LISTED);
    document.addEventListener("keydown", down);
    document.addEventListener("keyup", up);
    addEventListener("blur", blur);
    onCleanup(() => {
      document.removeEventListener("keydown", down);
      document.removeEventListener("keyup", up);
      removeEventListener("blur", blur);
    });
  }

  /** Lead on as before: what is under the finger was exchanged. */
  resume(): void {
    this.again?.(performance.now());
  }

  /** Push harder and harder until lift(). */
  hold(at_ms: number): void {
    this.begin("hold");
    const start_ms = at_ms;
    const push = (now_ms: number) => {
      const force_cN = Math.min(MOST_cN, (GROWS_cN_s * Math.max(0, now_ms - start_ms)) / 1000);
      this.session.push(force_cN, now_ms);
      this.growing = requestAnimationFrame(push);
    };
    this.again = push;
    push(at_ms);
  }

  /** Follow a key that tells how deep it is; what else leads the finger ends. */
  follow(depth_mm: number, velocity_mm_s: number, at_ms: number): void {
    if (this.how.peek() !== "travel") this.begin("travel");
    this.aim_mm.set(depth_mm);
    this.again = (now_ms) => this.session.follow?.(depth_mm, 0, now_ms);
    this.session.follow?.(depth_mm, velocity_mm_s, at_ms);
  }

  lift(at_ms: number): void {
    this.begin("");
    this.session.lift(at_ms);
  }

  private begin(how: How): void {
    cancelAnimationFrame(this.growing);
    this.growing = 0;
    this.again = null;
    this.aim_mm.set(null);
    if (how !== "height") this.held = null;
    this.how.set(how);
  }

  private height(mm: number, at_ms: number): void {
    if (this.how.peek() !== "height") this.begin("height");
    // a hand that has stopped sends no more: a speed is valid only while moves follow each other
    const since_ms = this.held ? at_ms - this.held.at_ms : Infinity;
    const speed = since_ms > 0 && since_ms < 40 && this.held ? ((mm - this.held.mm) / since_ms) * 1000 : 0;
    this.held = { at_ms, mm };
    this.aim(mm, at_ms, speed);
    this.settle(mm);
  }

  /** Without a further move the finger must stop where the pointer is, not run on. */
  private settle(mm: number): void {
    cancelAnimationFrame(this.growing);
    this.growing = requestAnimationFrame(() => {
      this.growing = requestAnimationFrame(
        (now_ms) => this.how.peek() === "height" && this.aim(mm, now_ms, 0),
      );
    });
  }

  private aim(mm: number, at_ms: number, velocity_mm_s: number, near_1_s?: number): void {
    this.aim_mm.set(mm);
    this.again = (now_ms) => this.session.lead(mm, 0, now_ms, near_1_s);
    this.session.lead(mm, velocity_mm_s, at_ms, near_1_s);
  }

  private press(event: PointerEvent): void {
    if (this.how.peek() !== "pressure") this.begin("pressure");
    const force_cN = event.pressure * FULL_PRESSURE_cN;
    this.again = (now_ms) => this.session.push(force_cN, now_ms);
    this.session.push(force_cN, event.timeStamp);
  }

  private key(at_ms: number): void {
    this.begin("key");
    const travel_mm = this.session.travel_mm() ?? 4;
    const bottom_mm = travel_mm + this.options.push_cN() * YIELD_mm_cN + PULP_mm;
    this.aim(bottom_mm, at_ms, 0, this.rate(bottom_mm - LIFTED_mm));
  }

  private release(at_ms: number): void {
    const from_mm = this.aim_mm.peek() ?? 0;
    this.begin("");
    this.session.lead(LIFTED_mm, 0, at_ms, this.rate(from_mm - LIFTED_mm));
  }

  private rate(way_mm: number): number {
    return (RATE_PER_SPEED * this.options.speed_mm_s()) / Math.max(1, way_mm);
  }

  private nudge(by_mm: number, at_ms: number): void {
    const from_mm = this.how.peek() === "height" ? (this.aim_mm.peek() ?? 0) : 0;
    const travel_mm = this.session.travel_mm() ?? 4;
    const mm = Math.min(travel_mm + 5, Math.max(LIFTED_mm, from_mm + by_mm));
    this.begin("height");
    this.aim(mm, at_ms, 0);
  }
}

/** Pens tell how hard they press; fingers do where the screen can, else 0 or 0.5 for every touch. */
function hasPressure(event: PointerEvent): boolean {
  const { pressure } = event;
  return (
    event.pointerType === "pen" ||
    (event.pointerType === "touch" && pressure > 0 && pressure < 1 && pressure !== 0.5)
  );
}

function taken(target: EventTarget | null, key: string): boolean {
  return (
    target instanceof HTMLElement &&
    // the space bar does nothing on a slider
    !(key === " " && target.matches("input[type=range]")) &&
    target.matches("button, a, input, select, textarea, summary, [role=tab], [contenteditable]")
  );
}
