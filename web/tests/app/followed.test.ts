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

/** Return something followed, and what answers each ask that came. */
function held() {
  const answers: ((value: number) => void)[] = [];
  return { answers, followed: new Followed(() => new Promise<number>((answer) => answers.push(answer))) };
}

it("asks once more, not once each, where changes come while it asks", async () => {
  const { answers, followed } = held();
  const first = followed.refresh();
  const later = [followed.refresh(), followed.refresh()];
  answers[0]?.(1);
  await first;
  expect(followed.detail.peek()).toBe(1);
  await vi.waitFor(() => expect(answers.length).toBe(2));
  answers[1]?.(2);
  await Promise.all(later);
  expect([answers.length, followed.detail.peek()]).toEqual([2, 2]);
  void followed.refresh();
  expect(answers.length).toBe(3);
});

it("lets who did something wait for an answer that knows of it, and not for all that comes after", async () => {
  const { answers, followed } = held();
  const seen: (number | null)[] = [];
  void followed.refresh();
  const after = followed.after(Promise.resolve()).then(() => seen.push(followed.detail.peek()));
  await Promise.resolve();
  answers[0]?.(1);
  await vi.waitFor(() => expect(answers.length).toBe(2));
  expect(seen).toEqual([]);
  void followed.refresh();
  answers[1]?.(2);
  await after;
  expect(seen).toEqual([2]);
});

it("does not ask anew after what was refused", async () => {
  const { answers, followed } = held();
  await expect(followed.after(Promise.reject(new Error("no")))).rejects.toThrow("no");
  expect(answers.length).toBe(0);
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
