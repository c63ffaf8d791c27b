// @vitest-environment jsdom
import { mount } from "svelte";
import { describe, expect, it, vi } from "vitest";
import { batch, computed, effect, onCleanup, scope, signal, untracked } from "../../src/ui/signal.svelte";
import Holding from "./Holding.svelte";

// as it is shipped: while developing, Svelte writes down every change of an endless loop, for ten seconds
vi.mock("esm-env", () => ({ BROWSER: true, DEV: false, NODE: false }));

describe("signals", () => {
  it("run an effect again when what it read changes, and only then", () => {
    const [a, b] = [signal(1), signal(10)];
    const seen: number[] = [];
    effect(() => {
      seen.push(a());
    });
    b.set(11);
    a.set(2);
    a.set(2);
    expect(seen).toEqual([1, 2]);
  });

  it("forget what an effect no longer reads", () => {
    const [which, a, b] = [signal(true), signal(1), signal(2)];
    let runs = 0;
    effect(() => {
      runs++;
      which() ? a() : b();
    });
    which.set(false);
    a.set(5);
    expect(runs).toBe(2);
    b.set(6);
    expect(runs).toBe(3);
  });

  it("run once for changes that are made together", () => {
    const [a, b] = [signal(1), signal(2)];
    const seen: number[] = [];
    effect(() => {
      seen.push(a() + b());
    });
    batch(() => {
      a.set(10);
      b.set(20);
    });
    expect(seen).toEqual([3, 30]);
  });

  it("follow computed values", () => {
    const a = signal(2);
    const square = computed(() => a() ** 2);
    const seen: number[] = [];
    effect(() => {
      seen.push(square());
    });
    a.set(-2);
    a.set(3);
    expect(seen).toEqual([4, 9]);
  });

  it("end with their scope, what was made first undone first", () => {
    const a = signal(1);
    const said: string[] = [];
    const end = scope(() => {
      onCleanup(() => said.push("first"));
      effect(() => {
        said.push(`run ${a()}`);
        onCleanup(() => said.push("undone"));
      });
    });
    a.set(2);
    end();
    a.set(3);
    expect(said).toEqual(["run 1", "undone", "run 2", "first", "undone"]);
  });

  it("are changed while a component is made, once", () => {
    const [shown, value] = [signal(false), signal(0)];
    mount(Holding, { target: document.body, props: { shown, value } });
    shown.set(true);
    expect([value(), document.body.textContent?.trim()]).toEqual([1, "1"]);
  });

  it("do not follow what is read untracked or peeked at", () => {
    const a = signal(1);
    let runs = 0;
    effect(() => {
      runs++;
      untracked(() => a());
      a.peek();
    });
    a.set(2);
    expect(runs).toBe(1);
  });

  it("let a run wait, and drop it when the effect has ended", () => {
    const a = signal(1);
    const due: (() => void)[] = [];
    const seen: number[] = [];
    const stop = effect(
      () => {
        seen.push(a());
      },
      (run) => due.push(run),
    );
    a.set(2);
    expect(seen).toEqual([1]);
    due.shift()?.();
    expect(seen).toEqual([1, 2]);
    a.set(3);
    stop();
    due.shift()?.();
    expect(seen).toEqual([1, 2]);
  });

  it("reach everyone who follows, although one of them fails, which is reported", () => {
    const report = vi.fn();
    vi.stubGlobal("reportError", report);
    const a = signal(0);
    let seen = 0;
    effect(() => {
      if (a() === 1) throw new Error("one fails");
    });
    effect(() => {
      seen = a();
    });
    a.set(1);
    expect(seen).toBe(1);
    a.set(2);
    expect(seen).toBe(2);
    expect(report.mock.calls).toEqual([[new Error("one fails")]]);
  });

  it("refuse to change each other without end", () => {
    const [a, b] = [signal(0), signal(0)];
    effect(() => b.set(a() + 1));
    effect(() => {
      if (b() > 1) a.set(b() + 1);
    });
    expect(() => a.set(1)).toThrow("effect_update_depth_exceeded");
    const other = signal(0);
    let seen = 0;
    effect(() => {
      seen = other();
    });
    other.set(1);
    expect(seen).toBe(1);
  });
});
