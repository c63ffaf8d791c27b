// @vitest-environment jsdom
import { flushSync, mount, unmount } from "svelte";
import { toast } from "svelte-sonner";
import { afterEach, describe, expect, it, vi } from "vitest";
import { Busy, dismissNotices } from "../../src/ui";
import Sending from "./Sending.svelte";

afterEach(() => dismissNotices(true));

/** Return work that ends when asked to, and how often it began. */
function held() {
  const ends: { resolve: () => void; reject: (error: Error) => void }[] = [];
  const work = () => new Promise<void>((resolve, reject) => ends.push({ resolve, reject }));
  return { work, ends };
}

describe("work that a person waits for", () => {
  it("is done once however often it is asked for meanwhile, and again afterwards", async () => {
    const { work, ends } = held();
    const busy = new Busy();
    const first = busy.run(work);
    await busy.run(work);
    const other = vi.fn();
    await busy.run(other);
    expect([ends.length, other.mock.calls.length, busy.on]).toEqual([1, 0, true]);
    ends[0]!.resolve();
    await first;
    expect(busy.on).toBe(false);
    void busy.run(work);
    expect(ends.length).toBe(2);
  });

  it("frees the button when it fails, and says why where the component wants it", async () => {
    const said: unknown[] = [];
    const busy = new Busy((error) => said.push(error));
    const error = new Error("no such run");
    await busy.run(() => Promise.reject(error));
    await busy.run(() => {
      throw error;
    });
    expect([said, busy.on]).toEqual([[error, error], false]);
  });

  it("says why it failed in a notice if nothing else is wanted", async () => {
    await new Busy().run(() => Promise.reject(new Error("the rig is away")));
    const notices = toast.getActiveToasts().map((one) => one.componentProps?.text);
    expect(notices).toEqual(["the rig is away"]);
  });

  it("disables a button and changes its words until it is over, well or badly", async () => {
    const { work, ends } = held();
    const wrong = vi.fn();
    const app = mount(Sending, { target: document.body, props: { send: work, wrong } });
    const button = document.querySelector("button")!;
    const shows = () => {
      flushSync();
      return [button.textContent, button.disabled] as const;
    };
    for (const end of ["resolve", "reject"] as const) {
      expect(shows()).toEqual(["Send", false]);
      button.click();
      // the second click of a double click, before the page is drawn anew
      button.click();
      expect(shows()).toEqual(["Sending …", true]);
      ends.at(-1)![end](new Error("refused"));
      await vi.waitFor(() => expect(shows()).toEqual(["Send", false]));
    }
    expect([ends.length, wrong.mock.calls.length]).toEqual([2, 1]);
    await unmount(app);
  });
});
