// @vitest-environment jsdom
import { describe, expect, it } from "vitest";
import { address, followAddress, go, keepQuery, parseRoute, route } from "../../src/app/route";

const changed = () => new Promise((done) => addEventListener("hashchange", done, { once: true }));

describe("an address", () => {
  it("is read as it was written", () => {
    for (const id of ["", "own:my button", "measured:0123/../?#%", "é"]) {
      const read = parseRoute(address("edit", id, { overlay: "a,b", q: "x&y=1" }));
      expect([read.page, read.id, read.query.get("overlay"), read.query.get("q")]).toEqual([
        "edit",
        id,
        "a,b",
        "x&y=1",
      ]);
    }
  });

  it("is read whatever a person types", () => {
    for (const hash of ["", "#", "#/", "#/edit", "#edit/x", "#/edit/%", "#/a/b/c?d"])
      expect(() => parseRoute(hash)).not.toThrow();
    expect(parseRoute("#/edit/%").id).toBe("%");
  });
});

describe("the state of a view", () => {
  it("is kept in the address without a step in the browser's history", () => {
    location.hash = "";
    followAddress();
    const steps = history.length;
    keepQuery({ q: "mx" });
    keepQuery({ q: "mx clear" });
    expect([location.hash, history.length]).toEqual([address("", "", { q: "mx clear" }), steps]);
  });

  it("does not write over an address the browser has not reported yet", async () => {
    followAddress();
    for (const leave of [
      () => go("press", "own:a"),
      () => go("press", "own:a", { mode: "measured" }),
      () => go("library"),
    ]) {
      const change = changed();
      leave();
      keepQuery({ q: "late" });
      await change;
      expect(location.hash).not.toContain("late");
      expect(route.peek()).toEqual(parseRoute(location.hash));
    }
  });
});
