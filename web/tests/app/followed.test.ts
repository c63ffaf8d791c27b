// @vitest-environment jsdom
import { flushSync, mount } from "svelte";
import { expect, it, vi } from "vitest";
import { Followed } from "../../src/app/followed";
import { StudioError } from "../../src/net";
import Toasts from "../../src/ui/Toasts.svelte";

// jsdom has none, and the toasts ask it whether motion is wanted
vi.stubGlobal("matchMedia", () => Object.assign(new EventTarget(), { matches: false }));

mount(Toasts, { target: document.body });
const toasts = () => flushSync(() => document.querySelectorAll(".toast.wrong").length);

it("asks once more, not once each, where changes come while it asks", async () => {
  const answers: ((value: number) => void)[] = [];
  const followed = new Followed(() => new Promise<number>((answer) => answers.push(answer)));
  const first = followed.refresh();
  void followed.refresh();
  void followed.refresh();
  answers[0]?.(1);
  await Promise.resolve();
  await Promise.resolve();
  expect([answers.length, followed.detail.peek()]).toEqual([2, 1]);
  answers[1]?.(2);
  await first;
  expect([answers.length, followed.detail.peek()]).toEqual([2, 2]);
});

it("says in its place why nothing can be shown, and beside what is shown why it is not newer", async () => {
  let fault: Error | null = new StudioError("there is none", 400);
  const followed = new Followed(() => (fault ? Promise.reject(fault) : Promise.resolve(1)));
  await followed.refresh();
  expect([followed.wrong.peek(), followed.detail.peek(), toasts()]).toEqual(["there is none", null, 0]);
  fault = null;
  await followed.refresh();
  expect([followed.wrong.peek(), followed.detail.peek()]).toEqual(["", 1]);
  fault = new StudioError("gone", 400);
  await followed.refresh();
  expect([followed.wrong.peek(), followed.detail.peek(), toasts()]).toEqual(["", 1, 1]);
});
