import { describe, expect, test } from "vitest";
import { DocumentStore, movePoints, type SaveState, setNumber } from "../../src/model";
import { builtIn, example } from "../golden/golden";
import { drawn } from "../math/near";
import { randomEdit } from "./random";
import { BUTTON, ScriptedServer, stillSurroundings } from "./server";

const clear = builtIn("mx-clear");
const points = { stroke: "press", velocity_mm_s: 0.5, indices: [4] } as const;

async function opened(server = new ScriptedServer(clear), name = "one") {
  const around = stillSurroundings(name);
  const store = await DocumentStore.open(server, BUTTON, around);
  const states: SaveState[] = [];
  store.onChange(() => {
    if (states[states.length - 1] !== store.state) states.push(store.state);
  });
  return { server, around, store, states };
}

test("an edit is seen at once, then saved", async () => {
  const { server, store, states } = await opened();
  expect(store.apply(setNumber("travel_mm", 3.5))).toBe(true);
  expect([store.model.travel_mm, store.state, store.unsaved]).toEqual([3.5, "saving", 1]);
  await store.settled();
  expect([store.state, store.unsaved, states]).toEqual(["saved", 0, ["saving", "saved"]]);
  expect(server.has(store.model)).toBe(true);
});

test("who hears that it is saved finds nothing unsaved", async () => {
  const { store } = await opened();
  const unsaved: number[] = [];
  store.onChange(() => {
    if (store.state === "saved") unsaved.push(store.unsaved);
  });
  store.apply(setNumber("travel_mm", 3.5));
  store.apply(setNumber("travel_mm", 3.6));
  await store.settled();
  expect(unsaved).toEqual([0]);
});

test("what is done fast is sent in order, and all of it", async () => {
  const { server, store } = await opened();
  store.apply(setNumber("travel_mm", 3.5));
  store.apply(setNumber("travel_mm", 3.6));
  store.undo();
  store.redo();
  store.undo(2);
  store.pin("start");
  await store.settled();
  expect(server.seen).toEqual(["edit", "edit", "undo", "redo", "undo", "pin"]);
  expect(server.has(clear)).toBe(true);
  expect((await server.open()).pins.map((pin) => pin.label)).toEqual(["start"]);
});

test("an edit that is refused here is never sent", async () => {
  const { server, store } = await opened();
  expect(() => store.apply(setNumber("actuation_mm", 9))).toThrow("actuation_mm must lie within");
  expect(store.apply(setNumber("actuation_mm", 2))).toBe(false);
  await store.settled();
  expect([server.seen, store.state]).toEqual([[], "saved"]);
});

test("a drag is one edit when it is released, none when it is cancelled", async () => {
  const { server, store } = await opened();
  store.mark("move");
  for (const delta of [1, 2, 3]) store.drag(movePoints([points], delta));
  expect(server.seen).toEqual([]);
  store.release();
  store.mark("move");
  store.drag(movePoints([points], 50));
  store.cancel();
  await store.settled();
  expect(server.seen).toEqual(["edit"]);
  expect(server.has(store.model)).toBe(true);
});

test("nudges are one step on both sides", async () => {
  const { server, around, store } = await opened();
  for (let i = 0; i < 3; i++) {
    around.time_s += 0.3;
    store.apply(movePoints([points], 0.5), "up");
  }
  await store.settled();
  expect([server.history.steps.length, store.steps.length]).toEqual([1, 1]);
  store.undo();
  await store.settled();
  expect(server.has(clear)).toBe(true);
});

describe("a lost connection", () => {
  test("delays what is done, with growing pauses, and says so", async () => {
    const { server, around, store, states } = await opened();
    server.troubles = ["out of reach", "out of reach", "out of reach", "out of reach", "out of reach"];
    store.apply(setNumber("travel_mm", 3.5));
    store.apply(setNumber("travel_mm", 3.4));
    await store.settled();
    expect(states).toEqual(["saving", "lost", "saving", "saved"]);
    expect(around.waits).toEqual([300, 1000, 2000, 5000, 5000]);
    expect(server.has(store.model)).toBe(true);
    expect(store.line).toBeNull();
  });

  test("with the answer lost makes nothing twice", async () => {
    const { server, store } = await opened();
    server.troubles = ["answer lost", "answer lost", undefined, "answer lost"];
    store.apply(setNumber("travel_mm", 3.5));
    store.undo();
    await store.settled();
    expect(server.seen).toEqual(["edit", "undo"]);
    expect(store.state).toBe("saved");
  });

  test("that is back is used at once", async () => {
    const { server, around, store } = await opened();
    around.wait = () => new Promise(() => undefined);
    server.troubles = ["out of reach", "out of reach"];
    store.apply(setNumber("travel_mm", 3.5));
    const lost = new Promise<void>((resolve) => store.onChange(() => store.state === "lost" && resolve()));
    await lost;
    expect([store.unsaved, server.troubles.length]).toEqual([1, 1]);
    await store.refresh();
    await new Promise((resolve) => setTimeout(resolve, 0));
    expect([store.state, server.troubles.length]).toEqual(["lost", 0]);
    await store.refresh();
    await store.settled();
    expect([store.state, server.has(store.model)]).toEqual(["saved", true]);
  });

  test("shows one line while it lasts", async () => {
    const { server, store } = await opened();
    const lines: (string | null)[] = [];
    store.onChange(() => lines.push(store.line));
    server.troubles = ["out of reach"];
    store.apply(setNumber("travel_mm", 3.5));
    await store.settled();
    expect(lines).toContain("the studio does not answer");
  });

  test("ends with the page", async () => {
    const { server, store } = await opened();
    server.troubles = Array.from({ length: 1000 }, () => "out of reach");
    store.apply(setNumber("travel_mm", 3.5));
    store.close();
    await store.settled();
    expect([store.unsaved, server.troubles.length]).toEqual([1, 999]);
  });
});

test("random work over a bad line arrives whole", async () => {
  for (let seed = 0; seed < 6; seed++) {
    const random = drawn(seed);
    const { server, store } = await opened();
    for (let i = 0; i < 60; i++) {
      server.troubles.push(random() < 0.3 ? "out of reach" : random() < 0.3 ? "answer lost" : undefined);
      const which = random();
      if (which < 0.15) store.undo(1 + Math.floor(random() * 3));
      else if (which < 0.25) store.redo();
      else {
        try {
          store.apply(randomEdit(store.model, random), which < 0.5 ? "nudge" : undefined);
        } catch (error) {
          expect((error as Error).name).toBe("ModelError");
        }
      }
      if (random() < 0.2) await store.settled();
    }
    await store.settled();
    expect(store.state).toBe("saved");
    expect(server.has(store.model)).toBe(true);
    expect(JSON.parse(JSON.stringify(store.steps))).toEqual(JSON.parse(JSON.stringify(server.history.steps)));
  }
});

test("a random session is one that Python replays to the same model", async () => {
  const random = drawn(41);
  const server = new ScriptedServer(example("mixed"));
  const { store } = await opened(server);
  for (let i = 0; i < 40; i++) {
    const which = random();
    if (which < 0.15) store.undo(1 + Math.floor(random() * 3));
    else if (which < 0.3) store.redo();
    else if (which < 0.35) store.pin(`pin ${i}`);
    else {
      try {
        store.apply(randomEdit(store.model, random), which < 0.7 ? "nudge" : undefined);
      } catch (error) {
        expect((error as Error).name).toBe("ModelError");
      }
    }
  }
  await store.settled();
  const session = { opening: example("mixed"), changes: server.changes, left: await server.open() };
  await expect(`${JSON.stringify(session)}\n`).toMatchFileSnapshot("../golden/session.json");
});

describe("two tabs", () => {
  async function pair() {
    const one = await opened();
    const two = await opened(one.server, "two");
    const heard: Promise<void>[] = [];
    for (const { store } of [one, two])
      one.server.tabs.add((revision) => heard.push(store.onRevision(revision)));
    const quiet = async () => {
      for (let i = 0; i < 5; i++) {
        await Promise.all([one.store.settled(), two.store.settled(), ...heard]);
      }
    };
    return { one: one.store, two: two.store, server: one.server, quiet };
  }

  test("follow each other while nothing is unsaved", async () => {
    const { one, two, quiet } = await pair();
    one.apply(setNumber("travel_mm", 3.5));
    await quiet();
    expect(two.model.travel_mm).toBe(3.5);
    two.undo();
    await quiet();
    expect([one.model.travel_mm, one.state, two.state]).toEqual([4, "saved", "saved"]);
    expect(one.before.travel_mm).toBe(4);
  });

  test("that edit the same state never overwrite each other", async () => {
    const { one, two, server, quiet } = await pair();
    one.apply(setNumber("travel_mm", 3.5));
    two.apply(setNumber("travel_mm", 3.6));
    await quiet();
    expect([one.state, two.state]).toEqual(["saved", "conflict"]);
    expect([server.history.model.travel_mm, two.model.travel_mm]).toEqual([3.5, 3.6]);
    expect(two.line).toBe("another tab edited this button; use its version, or keep yours as a copy");
    two.apply(setNumber("reset_mm", 1));
    await two.settled();
    expect([two.unsaved, server.seen]).toEqual([2, ["edit"]]);
  });

  test("in conflict take theirs, and go on", async () => {
    const { one, two, server, quiet } = await pair();
    one.apply(setNumber("travel_mm", 3.5));
    two.apply(setNumber("travel_mm", 3.6));
    await quiet();
    await two.takeTheirs();
    expect([two.model.travel_mm, two.state, two.unsaved, two.line]).toEqual([3.5, "saved", 0, null]);
    two.apply(setNumber("reset_mm", 1));
    await quiet();
    expect(server.has(two.model)).toBe(true);
    expect(one.model.reset_mm).toBe(1);
  });

  test("in conflict keep mine as a copy", async () => {
    const { one, two, server, quiet } = await pair();
    one.apply(setNumber("travel_mm", 3.5));
    two.apply(setNumber("travel_mm", 3.6));
    await quiet();
    expect(await two.keepMine("mine")).toBe("own:mine");
    expect(server.copies.map(([name, model]) => [name, model.travel_mm])).toEqual([["mine", 3.6]]);
    expect([two.model.travel_mm, two.state]).toEqual([3.5, "saved"]);
  });

  test("a drag under way is not disturbed; released it is a conflict, cancelled it follows", async () => {
    const { one, two, quiet } = await pair();
    two.mark("move");
    two.drag(movePoints([points], 5));
    one.apply(setNumber("travel_mm", 3.5));
    await quiet();
    expect(two.model.travel_mm).toBe(4);
    two.cancel();
    await quiet();
    expect(two.model.travel_mm).toBe(3.5);
    two.mark("move");
    two.drag(movePoints([points], 5));
    one.undo();
    await quiet();
    two.release();
    await quiet();
    expect(two.state).toBe("conflict");
  });
});

test("an edit made while the store looks at what others did is sent", async () => {
  const { server, store } = await opened();
  const open = server.open.bind(server);
  server.open = async () => {
    const found = await open();
    store.apply(setNumber("reset_mm", 1));
    server.open = open;
    return found;
  };
  server.make({ type: "pin", label: "theirs", change_id: "x" });
  await store.onRevision(1);
  await store.settled();
  expect(store.state).toBe("conflict");
  await store.takeTheirs();
  expect(store.pins.map((pin) => pin.label)).toEqual(["theirs"]);
});

test("what the server refuses is said, kept here, and can be kept as a copy or dropped", async () => {
  const { server, store } = await opened();
  server.troubles = ["refused"];
  store.apply(setNumber("travel_mm", 3.5));
  await store.settled();
  expect([store.state, store.line]).toEqual(["refused", "the model would break"]);
  expect([store.unsaved, store.model.travel_mm]).toEqual([1, 3.5]);
  await store.takeTheirs();
  expect([store.state, store.unsaved, store.model.travel_mm]).toEqual(["saved", 0, 4]);
});

test("a store finds out by itself what changed while the line was cut", async () => {
  const { server, store } = await opened();
  server.make({ type: "pin", label: "theirs", change_id: "x" });
  await store.refresh();
  expect(store.pins.map((pin) => pin.label)).toEqual(["theirs"]);
});

test("a document that is gone is said to be, and edits are not sent into the void", async () => {
  const { server, store } = await opened();
  store.gone("this button was deleted");
  store.apply(setNumber("travel_mm", 3.5));
  await store.settled();
  expect([store.state, store.line, store.unsaved, server.seen]).toEqual([
    "gone",
    "this button was deleted",
    1,
    [],
  ]);
});
