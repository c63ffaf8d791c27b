import { describe, expect, it } from "vitest";
import { Latest } from "../../../src/pages/edit/latest";

/** A server whose answers come when they are let go. */
function server() {
  const asked: { ask: number; answer: (fails?: boolean) => Promise<void> }[] = [];
  const work = (ask: number) =>
    new Promise<number>((resolve, reject) => {
      asked.push({
        ask,
        answer: async (fails = false) => {
          if (fails) reject(new Error(`no ${ask}`));
          else resolve(10 * ask);
          await Promise.resolve();
          await Promise.resolve();
        },
      });
    });
  const onAnswer: number[] = [];
  const wrong: string[] = [];
  const latest = new Latest(
    work,
    (answer: number) => onAnswer.push(answer),
    (e) => wrong.push((e as Error).message),
  );
  return { asked, onAnswer, wrong, latest };
}

describe("asking while a hand moves", () => {
  it("asks at once, then only the newest question that waits", async () => {
    const { asked, onAnswer, latest } = server();
    for (const ask of [1, 2, 3, 4]) latest.ask(ask);
    expect(asked.map((a) => a.ask)).toEqual([1]);
    await asked[0]?.answer();
    expect(asked.map((a) => a.ask)).toEqual([1, 4]);
    await asked[1]?.answer();
    expect(onAnswer).toEqual([10, 40]);
    latest.ask(5);
    expect(asked.map((a) => a.ask)).toEqual([1, 4, 5]);
  });

  it("goes on after a question that failed", async () => {
    const { asked, onAnswer, wrong, latest } = server();
    latest.ask(1);
    latest.ask(2);
    await asked[0]?.answer(true);
    await asked[1]?.answer();
    expect([wrong, onAnswer]).toEqual([["no 1"], [20]]);
  });

  it("tells nothing once it is closed", async () => {
    const { asked, onAnswer, latest } = server();
    latest.ask(1);
    latest.ask(2);
    latest.close();
    await asked[0]?.answer();
    expect([onAnswer, asked.length]).toEqual([[], 1]);
  });
});
