import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";
import { NUDGE_s, StepLine } from "../../../src/model/steps";
import type { ProgramCheck } from "../../../src/net/messages";
import { CHECK_AFTER_ms, ProgramBook, SAVE_AFTER_ms } from "../../../src/pages/programs/book";
import { readDocument, writeDocument } from "../../../src/programs/document";
import { addState, changeProgram, removeState, renameState } from "../../../src/programs/edits";
import { whole } from "../../../src/programs/history";
import { SHIPPED } from "../../programs/shipped";

const BUTTON = SHIPPED[0]!;
const FINE: ProgramCheck = {
  accepted: true,
  findings: [],
  sizes: [],
  surfaces: [],
  return_s: 0.5,
  stiffness_cN_mm: 1,
  rise_K: 1,
};

/** A server that keeps one file, as the real one does: by its revision. */
class Shelf {
  text = writeDocument(BUTTON);
  revision = 1;
  checks: string[] = [];
  broken: string | null = null;

  async check(text: string): Promise<ProgramCheck> {
    this.checks.push(text);
    return FINE;
  }

  async save(program: string, text: string, revision: string) {
    if (this.broken) throw new Error(this.broken);
    if (revision !== String(this.revision)) throw new Error("it was changed elsewhere");
    this.text = text;
    this.revision += 1;
    return { program, text, revision: String(this.revision) };
  }

  open(id = "own:one"): ProgramBook {
    return new ProgramBook(this, { program: id, text: this.text, revision: String(this.revision) });
  }
}

describe("the history of a document", () => {
  it("goes back and forth, and forgets what was undone once something else is done", () => {
    const history = new StepLine("a", whole<string>());
    history.put("to b", "b", { time_s: 0 });
    history.put("to c", "c", { time_s: 1 });
    history.undo();
    expect([history.present, history.undoLabel, history.redoLabel]).toEqual(["b", "to b", "to c"]);
    history.redo();
    expect(history.present).toBe("c");
    history.undo();
    history.put("to d", "d", { time_s: 2 });
    history.redo();
    expect([history.present, history.redoLabel]).toEqual(["d", null]);
    for (let i = 0; i < 5; i += 1) history.undo();
    expect(history.present).toBe("a");
  });

  it("makes one step of nudges that follow each other, and of a drag", () => {
    const history = new StepLine(0, whole<number>());
    history.put("nudge", 1, { time_s: 0, nudge: "n" });
    history.put("nudge", 2, { time_s: NUDGE_s, nudge: "n" });
    history.put("nudge", 3, { time_s: 2.01 * NUDGE_s, nudge: "n" });
    history.mark("drag");
    for (const by of [1, 5, 9]) history.show((before) => before + by);
    history.release(9);
    expect(history.present).toBe(12);
    history.undo();
    expect(history.present).toBe(3);
    history.undo();
    expect(history.present).toBe(2);
    history.undo();
    expect(history.present).toBe(0);
  });

  it("leaves nothing of a drag that was cancelled", () => {
    const history = new StepLine(0, whole<number>());
    history.mark("drag");
    history.show(() => 7);
    history.cancel();
    expect([history.present, history.undoLabel]).toEqual([0, null]);
  });
});

describe("an open program", () => {
  beforeEach(() => vi.useFakeTimers());
  afterEach(() => vi.useRealTimers());

  it("is checked when it is opened, and once after edits that follow each other", async () => {
    const shelf = new Shelf();
    const book = shelf.open();
    await vi.advanceTimersByTimeAsync(CHECK_AFTER_ms);
    expect(shelf.checks).toHaveLength(1);
    book.edit("rename", (held) => renameState(held, "up", "top"));
    book.edit("rename", (held) => renameState(held, "top", "high"));
    await vi.advanceTimersByTimeAsync(CHECK_AFTER_ms);
    expect(shelf.checks).toHaveLength(2);
    expect(readDocument(shelf.checks[1]!).start).toBe("high");
    expect(book.check()).toEqual(FINE);
    await book.close();
  });

  it("is written soon after an edit, and says how that went", async () => {
    const shelf = new Shelf();
    const book = shelf.open();
    book.edit("travel", (held) => changeProgram(held, { travel_mm: 2 }));
    expect(book.saved().kind).toBe("waiting");
    await vi.advanceTimersByTimeAsync(SAVE_AFTER_ms);
    expect(book.saved().kind).toBe("saved");
    expect(readDocument(shelf.text).travel_mm).toBe(2);
    book.undo();
    await vi.advanceTimersByTimeAsync(SAVE_AFTER_ms);
    expect(readDocument(shelf.text)).toEqual(BUTTON);
    await book.close();
  });

  it("does not overwrite what another tab wrote", async () => {
    const shelf = new Shelf();
    const [mine, theirs] = [shelf.open(), shelf.open()];
    theirs.edit("travel", (held) => changeProgram(held, { travel_mm: 2 }));
    await vi.advanceTimersByTimeAsync(SAVE_AFTER_ms);
    mine.edit("travel", (held) => changeProgram(held, { travel_mm: 3 }));
    await vi.advanceTimersByTimeAsync(SAVE_AFTER_ms);
    expect(mine.saved()).toEqual({ kind: "refused", line: "it was changed elsewhere" });
    expect(readDocument(shelf.text).travel_mm).toBe(2);
  });

  it("is written again after the server was away, with all that was done meanwhile", async () => {
    const shelf = new Shelf();
    const book = shelf.open();
    shelf.broken = "gone";
    book.edit("travel", (held) => changeProgram(held, { travel_mm: 2 }));
    await vi.advanceTimersByTimeAsync(SAVE_AFTER_ms);
    expect(book.saved()).toEqual({ kind: "refused", line: "gone" });
    shelf.broken = null;
    book.edit("add", (held) => addState(held)[0]);
    await book.save();
    expect(book.saved().kind).toBe("saved");
    expect(readDocument(shelf.text).states).toHaveLength(3);
  });

  it("of the shipped ones is never written", async () => {
    const shelf = new Shelf();
    const book = shelf.open("shipped:button");
    book.edit("travel", (held) => changeProgram(held, { travel_mm: 2 }));
    await vi.advanceTimersByTimeAsync(SAVE_AFTER_ms);
    await book.save();
    expect(book.saved().kind).toBe("scratch");
    expect(shelf.revision).toBe(1);
  });

  it("is checked and written after a drag, not within it", async () => {
    const shelf = new Shelf();
    const book = shelf.open();
    await vi.advanceTimersByTimeAsync(CHECK_AFTER_ms);
    book.mark("travel");
    book.drag((held) => changeProgram(held, { travel_mm: 2 }));
    await vi.advanceTimersByTimeAsync(SAVE_AFTER_ms);
    expect([book.document().travel_mm, shelf.checks.length, shelf.revision]).toEqual([2, 1, 1]);
    book.release();
    await vi.advanceTimersByTimeAsync(SAVE_AFTER_ms);
    expect([shelf.checks.length, shelf.revision]).toEqual([2, 2]);
    await book.close();
  });

  it("tells at once what the page can tell, and lets go of what is no longer there", () => {
    const book = new Shelf().open();
    book.choose({ kind: "state", state: "down" });
    book.edit("remove", (held) => removeState(held, "down"));
    expect(book.choice()).toEqual({ kind: "program" });
    book.edit("travel", (held) => changeProgram(held, { travel_mm: 99 }));
    expect(book.findings().map((found) => found.path)).toEqual(["travel_mm"]);
  });
});
