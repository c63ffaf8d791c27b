// @vitest-environment jsdom
import { flushSync, mount } from "svelte";
import { describe, expect, it } from "vitest";
import { addShortcuts, forceUnit, h, pressedKeys, scope, shortcuts, shown, signal } from "../../src/ui";
import NumberField from "../../src/ui/NumberField.svelte";

function enter(field: HTMLElement, text: string): HTMLInputElement {
  const input = field.querySelector("input") as HTMLInputElement;
  input.value = text;
  for (const kind of ["input", "change"]) input.dispatchEvent(new Event(kind, { bubbles: true }));
  flushSync();
  return input;
}

describe("elements", () => {
  it("never take text for markup", () => {
    const name = `<img src=x onerror="alert(1)">`;
    const made = h("p", { title: name }, name);
    expect(made.children).toHaveLength(0);
    expect(made.textContent).toBe(name);
    expect(made.getAttribute("title")).toBe(name);
  });

  it("follow signals in attributes and content", () => {
    const [label, busy] = [signal("a"), signal(false)];
    const made = h("button", { disabled: busy, "aria-label": label }, () => label());
    label.set("b");
    busy.set(true);
    expect([made.textContent, made.getAttribute("aria-label"), made.disabled]).toEqual(["b", "b", true]);
    busy.set(false);
    expect(made.disabled).toBe(false);
  });
});

describe("a number field", () => {
  const made = (over: { unit?: string; step?: number; most?: number } = {}) => {
    const value = signal(1.5);
    const field = document.body.appendChild(document.createElement("div"));
    mount(NumberField, {
      target: field,
      props: {
        label: "Travel",
        unit: "mm",
        set: value.set,
        least: 0,
        most: 6,
        ...over,
        get value() {
          return value();
        },
      },
    });
    flushSync();
    return { value, field };
  };

  it("takes what is typed, with comma or point", () => {
    const { value, field } = made();
    enter(field, "2,25");
    expect(value()).toBe(2.25);
  });

  it("refuses what is no number or out of bounds, in words beside it", () => {
    const { value, field } = made();
    for (const [text, said] of [
      ["x", "not a number"],
      ["", "not a number"],
      ["7", "at most 6 mm"],
      ["-1", "at least 0 mm"],
    ]) {
      const input = enter(field, text as string);
      expect(field.querySelector("[role=alert]")?.textContent).toBe(said);
      expect(input.hasAttribute("aria-invalid")).toBe(true);
    }
    expect(value()).toBe(1.5);
  });

  it("moves by its step with the arrow keys, and keeps its bounds", () => {
    const { value, field } = made({ step: 0.5 });
    const input = field.querySelector("input") as HTMLInputElement;
    const press = (key: string, more: KeyboardEventInit = {}) => {
      input.dispatchEvent(new KeyboardEvent("keydown", { key, bubbles: true, ...more }));
      flushSync();
    };
    press("ArrowUp");
    press("ArrowUp", { shiftKey: true });
    expect(value()).toBe(2);
    press("ArrowDown", { altKey: true });
    expect(value()).toBeCloseTo(1.95, 12);
  });

  it("shows and takes a force in the unit that is chosen, and sets it in its own", () => {
    const { value, field } = made({ unit: "cN", most: 100 });
    forceUnit.set("N");
    flushSync();
    const input = enter(field, "0.25");
    expect([value(), input.value]).toEqual([25, "0.25"]);
    enter(field, "2");
    expect(field.querySelector("[role=alert]")?.textContent).toBe("at most 1 N");
    forceUnit.set("cN");
  });

  it("shows numbers with a true minus and without idle zeros", () => {
    expect([shown(-1.5), shown(2), shown(0.1234, 3)]).toEqual(["−1.5", "2", "0.123"]);
  });
});

describe("shortcuts", () => {
  it("are written as they are pressed", () => {
    const event = (key: string, more: KeyboardEventInit = {}) =>
      pressedKeys(new KeyboardEvent("keydown", { key, ...more }));
    expect(event("z", { ctrlKey: true })).toBe("Ctrl+Z");
    expect(event("z", { metaKey: true, shiftKey: true })).toBe("Ctrl+Shift+Z");
    expect(event("?", { shiftKey: true })).toBe("?");
    expect(event(" ")).toBe("Space");
    expect(event("ArrowUp", { shiftKey: true })).toBe("Shift+ArrowUp");
  });

  it("end with the scope that added them", async () => {
    const end = scope(() => addShortcuts({ keys: "x", does: "nothing", act: () => undefined }));
    await Promise.resolve();
    expect(shortcuts()).toHaveLength(1);
    end();
    await Promise.resolve();
    expect(shortcuts()).toHaveLength(0);
  });
});
