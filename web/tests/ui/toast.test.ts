// @vitest-environment jsdom
import { toast as sonner } from "svelte-sonner";
import { afterEach, expect, it, vi } from "vitest";
import { copyText, dismissNotices } from "../../src/ui";

afterEach(() => {
  dismissNotices(true);
  vi.unstubAllGlobals();
});

/** Return what the notices say. */
const notices = () => sonner.getActiveToasts().map((one) => one.componentProps?.text ?? one.title);

it("a text is put on the clipboard, and a notice says so", async () => {
  const writeText = vi.fn(async () => undefined);
  vi.stubGlobal("navigator", { clipboard: { writeText } });
  await copyText("http://studio/?seat=1", "Link copied.");
  expect([writeText.mock.calls, notices()]).toEqual([[["http://studio/?seat=1"]], ["Link copied."]]);
});

it("where the browser refuses or has no clipboard, a notice says why", async () => {
  vi.stubGlobal("navigator", { clipboard: { writeText: () => Promise.reject(new Error("not allowed")) } });
  await copyText("x");
  vi.stubGlobal("navigator", {});
  await copyText("x");
  expect(notices().sort()).toEqual([
    "not allowed",
    "the browser allows no copying here: select the text instead",
  ]);
});
