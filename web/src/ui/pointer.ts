/** A pointer that is held down. */

type Held = (event: PointerEvent) => void;

/**
 * Follow the pointer that was just pressed on an element until it is let go.
 *
 * move: called wherever it goes, also outside the element. end: called once; kept is false where the pointer was
 * taken away, as by a gesture of the system.
 */
export function followPointer(
  element: Element,
  down: PointerEvent,
  move: Held,
  end: (kept: boolean) => void = () => undefined,
): void {
  const over = new AbortController();
  const on = (name: "pointermove" | "pointerup" | "pointercancel", work: Held) => {
    const mine = (event: Event) =>
      (event as PointerEvent).pointerId === down.pointerId && work(event as PointerEvent);
    element.addEventListener(name, mine, { signal: over.signal });
  };
  const ends = (kept: boolean) => () => {
    over.abort();
    end(kept);
  };
  element.setPointerCapture(down.pointerId);
  on("pointermove", move);
  on("pointerup", ends(true));
  on("pointercancel", ends(false));
}
