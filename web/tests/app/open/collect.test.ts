import { expect, test } from "vitest";
import { MOST_bytes, type Picked, questions } from "../../../src/app/open/collect";

const picked = (name: string, size = 10): Picked => ({ name, file: { size } as File });
const names = (files: readonly Picked[]) => questions(files).map((part) => part.map(({ name }) => name));

test("a question has at most 64 files, and all files are asked for once", () => {
  const files = Array.from({ length: 150 }, (_, i) => picked(`${i}.csv`));
  expect(questions(files).map((part) => part.length)).toEqual([64, 64, 22]);
  expect(questions(files).flat()).toEqual(files);
});

test("a question is no larger than the server takes", () => {
  const third = MOST_bytes / 3;
  expect(names([picked("a", third), picked("b", third), picked("c", third), picked("d", 1)])).toEqual([
    ["a", "b", "c"],
    ["d"],
  ]);
});

test("the two files of a press and its release are in one question, wherever the cut would be", () => {
  const many = Array.from({ length: 63 }, (_, i) => picked(`${i}.csv`));
  const pair = [picked("x/Two.downstroke.csv"), picked("x/Two.upstroke.csv")];
  expect(questions([pair[0]!, ...many, pair[1]!]).find((part) => part.includes(pair[0]!))).toContain(pair[1]);
  expect(names([...many, ...pair]).at(-1)).toEqual(["x/Two.downstroke.csv", "x/Two.upstroke.csv"]);
});
