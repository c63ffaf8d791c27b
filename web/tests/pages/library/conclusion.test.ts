/** What a comparison comes to names whose just noticeable differences it counts. */

import { expect, it } from "vitest";
import type { LibraryButton } from "../../../src/net/messages";
import { many, two } from "../../../src/pages/library/conclusion";

const button = (id: string, peak_cN: number) =>
  ({ id, name: id, numbers: { peak_cN } }) as unknown as LibraryButton;
const [clear, brown, red] = [button("clear", 66), button("brown", 55), button("red", 45)];
const whose = "JNDs of 12 people of study weights";

it.each([
  [0.6, "0.6 JND apart: computed to feel alike, by JNDs of 12 people of study weights."],
  [1.4, "1.4 JND apart: computed to feel different, by JNDs of 12 people of study weights."],
])("two buttons %d JND apart are judged by whose JNDs count", (jnd, end) => {
  expect(two(clear, brown, { jnd: new Map([["brown", jnd]]), whose })).toMatch(new RegExp(`; ${end}$`));
});

it("without a distance nothing is said of what is noticed", () => {
  expect(two(clear, brown, { jnd: new Map(), whose: "" })).toBe(
    "clear against brown: peak 66.0 against 55.0 cN.",
  );
});

it("of several the nearest and the farthest are named, with whose JNDs count", () => {
  const jnd = new Map([
    ["brown", 1.4],
    ["red", 3.2],
  ]);
  expect(many(clear, [brown, red], { jnd, whose })).toBe(
    `brown (1.4 JND) feels nearest to clear, red (3.2 JND) least like it, by ${whose}.`,
  );
});
