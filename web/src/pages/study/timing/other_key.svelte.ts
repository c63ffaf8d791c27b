/** The one line that names the key which counts, after another was pressed. */

/** Keys that one writes or plays with; others lead about a page. */
const WRITES = /^(.|F\d+)$/u;
const SHOWN_ms = 4000;

/** Whether a key that does not count was meant as a press. */
export function meant(event: KeyboardEvent): boolean {
  return !event.repeat && WRITES.test(event.key);
}

/** Shows that another key was pressed, for a while. */
export class OtherKey {
  pressed = $state(false);
  private timer = 0;

  take(event: KeyboardEvent): void {
    if (!meant(event)) return;
    this.pressed = true;
    clearTimeout(this.timer);
    this.timer = window.setTimeout(() => (this.pressed = false), SHOWN_ms);
  }

  /** The right one was pressed. */
  clear(): void {
    clearTimeout(this.timer);
    this.pressed = false;
  }
}
