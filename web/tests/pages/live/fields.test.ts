import { describe, expect, it } from "vitest";
import { settings } from "../../../src/net";
import { nameFor, speedsOf } from "../../../src/pages/live/fields";

describe("speeds in one field", () => {
  it("are read with commas, spaces or both", () => {
    for (const text of ["50,100", " 50  100 ", "50, 100,", "50;100"])
      expect(speedsOf(text, settings.probe.velocities_mm_s)).toEqual([50, 100]);
  });

  it("are refused in words a person understands", () => {
    expect(speedsOf("", settings.probe.velocities_mm_s)).toMatch(/1 to 16/);
    expect(speedsOf("50,fast", settings.probe.velocities_mm_s)).toMatch(/5 to 500 mm\/s/);
    expect(speedsOf("10", settings.capture.paces_mm_s)).toMatch(/20 to 500/);
    expect(speedsOf("50,50.0", settings.probe.velocities_mm_s)).toMatch(/twice/);
  });
});

describe("the name of a result", () => {
  it("is one that a file may bear", () => {
    expect(nameFor("builtin:mx-clear", " tuned")).toBe("mx-clear tuned");
    expect(nameFor("measured:00ff", "")).toBe("00ff");
    expect(nameFor("own:a/b:c", "")).toBe("a-b-c");
    expect(nameFor(`own:${"x".repeat(99)}`, "").length).toBe(80);
  });
});
