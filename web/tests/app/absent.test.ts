// @vitest-environment jsdom
import { expect, it, vi } from "vitest";
import { askAbsent } from "../../src/app/absent";
import { tasksHere } from "../../src/app/current";
import { recent } from "../../src/pages/home/recent";

it("neither offers nor asks for the pages that are not installed", async () => {
  const asked: string[] = [];
  vi.stubGlobal("fetch", (path: string) => {
    asked.push(path);
    return Promise.resolve(
      Response.json({ absent: { "fdvv-people": ["optimize", "studies"] }, rows: [], jobs: [] }),
    );
  });
  expect(tasksHere().map(({ page }) => page)).toContain("studies");
  await askAbsent();
  expect(tasksHere().map(({ page }) => page)).toEqual(["library", "edit", "press", "live"]);
  expect(await recent(() => expect.unreachable())).toEqual([]);
  expect(asked).toEqual(["./api/studio.about", "./api/document.list", "./api/jobs.list"]);
});
