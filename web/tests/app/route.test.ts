import { describe, expect, it } from "vitest";
import { address, parseRoute } from "../../src/app/route";

describe("an address", () => {
  it("is read as it was written", () => {
    for (const id of ["", "own:my button", "measured:0123/../?#%", "é"]) {
      const read = parseRoute(address("edit", id, { overlay: "a,b", q: "x&y=1" }));
      expect([read.page, read.id, read.query.get("overlay"), read.query.get("q")]).toEqual(["edit", id, "a,b", "x&y=1"]);
    }
  });

  it("is read whatever a person types", () => {
    for (const hash of ["", "#", "#/", "#/edit", "#edit/x", "#/edit/%", "#/a/b/c?d"]) expect(() => parseRoute(hash)).not.toThrow();
    expect(parseRoute("#/edit/%").id).toBe("%");
  });
});
