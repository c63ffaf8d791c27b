// @vitest-environment jsdom
import { beforeEach, describe, expect, it } from "vitest";
import { followPointer } from "../../src/ui";

function pointer(type: string, pointerId: number): PointerEvent {
  return Object.assign(new Event(type), { pointerId }) as unknown as PointerEvent;
}

describe("a held pointer", () => {
  let element: HTMLElement;
  let events: string[];
  const send = (type: string, id = 1) => element.dispatchEvent(pointer(type, id));

  beforeEach(() => {
    element = Object.assign(document.createElement("div"), { setPointerCapture: () => undefined });
    events = [];
    followPointer(
      element,
      pointer("pointerdown", 1),
      () => events.push("move"),
      (kept) => events.push(kept ? "kept" : "lost"),
    );
  });

  it("is followed until it is let go, and no more", () => {
    for (const type of [
      "pointermove",
      "pointermove",
      "pointerup",
      "pointermove",
      "pointercancel",
      "pointerup",
    ])
      send(type);
    expect(events).toEqual(["move", "move", "kept"]);
  });

  it("ends as lost where it is taken away", () => {
    for (const type of ["pointermove", "pointercancel", "pointermove", "pointerup"]) send(type);
    expect(events).toEqual(["move", "lost"]);
  });

  it("is not mistaken for another finger", () => {
    for (const type of ["pointermove", "pointerup"]) send(type, 2);
    expect(events).toEqual([]);
  });
});
