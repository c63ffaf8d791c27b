import { describe, expect, it } from "vitest";
import type { ProgramFinding } from "../../../src/net/messages";
import { verdictOf } from "../../../src/pages/programs/verdict";
import { SHIPPED } from "../../programs/shipped";

const NEXT = { label: "Press it" };
const found = (severity: ProgramFinding["severity"], reason: string): ProgramFinding => ({
  severity,
  reason,
  path: "states[1]",
  state: "down",
  place: "whole state",
  remedy: "",
  at_mm: null,
});

function verdict(findings: readonly ProgramFinding[], checked = true) {
  const shown: ProgramFinding[] = [];
  const book = { findings: () => findings, check: () => (checked ? {} : null), document: () => SHIPPED[0] };
  const said = verdictOf(book as Parameters<typeof verdictOf>[0], (one) => shown.push(one), NEXT);
  return { ...said, shown };
}

describe("what is said of a program", () => {
  it("is that it is ready, and how many states it has", () => {
    expect(verdict([])).toMatchObject({
      sentence: "Ready: 2 states, no findings.",
      kind: "good",
      next: NEXT,
    });
  });

  it("is the first refusal, before any warning, and leads to it", () => {
    const refused = found("refused", "no way leads to it");
    const { sentence, next, shown } = verdict([found("warning", "it is steep"), refused]);
    expect(sentence).toBe("Not ready: no way leads to it (down, whole state; 1 more).");
    next?.act?.();
    expect(shown).toEqual([refused]);
  });

  it("names a warning and still goes on to the press", () => {
    const { sentence, kind, next } = verdict([found("warning", "it is steep")]);
    expect(sentence).toBe("Ready: 2 states, but it is steep (down, whole state).");
    expect([kind, next]).toEqual(["warning", NEXT]);
  });

  it("is nothing yet before the check has answered", () => {
    expect(verdict([], false)).toMatchObject({ sentence: "Checking the program…" });
  });
});
