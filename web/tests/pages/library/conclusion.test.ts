/** What a comparison comes to names whose just noticeable differences it counts. */

import { expect, it } from "vitest";
import type { LibraryButton } from "../../../src/net/messages";
import { compared, many, two } from "../../../src/pages/library/conclusion";

const button = (id: string, peak_cN: number) =>
  ({ id, name: id, numbers: { peak_cN } }) as unknown as LibraryButton;
const [clear, brown, red] = [button("clear", 66), button("brown", 55), button("red", 45)];
const whose = "JNDs of 12 people of study weights";
const NONE = { jnd: new Map(), whose: "", fault: "" };

it.each([
  [0.6, "0.6 JND apart: computed to feel alike, by JNDs of 12 people of study weights."],
  [1.4, "1.4 JND apart: computed to feel different, by JNDs of 12 people of study weights."],
])("two buttons %d JND apart are judged by whose JNDs count", (jnd, end) => {
  expect(two(clear, brown, { jnd: new Map([["brown", jnd]]), whose, fault: "" })).toMatch(
    new RegExp(`; ${end}$`),
  );
});

it("without a distance nothing is said of what is noticed", () => {
  expect(two(clear, brown, NONE)).toBe("clear against brown: peak 66.0 against 55.0 cN.");
});

it("of several the nearest and the farthest are named, with whose JNDs count", () => {
  const jnd = new Map([
    ["brown", 1.4],
    ["red", 3.2],
  ]);
  expect(many(clear, [brown, red], { jnd, whose, fault: "" })).toBe(
    `brown (1.4 JND) feels nearest to clear, red (3.2 JND) least like it, by ${whose}.`,
  );
});

it.each([
  [[brown], "clear against brown: peak 66.0 against 55.0 cN."],
  [[brown, red], "3 buttons compared with clear."],
])("where no distance could be computed the reason takes its place", (others, said) => {
  const fault = "jnds.json: end of file: not valid JSON; write it again, or remove it";
  expect(compared(clear, others, { ...NONE, fault })).toEqual({
    sentence: `${said} No distance: ${fault}.`,
    kind: "warning",
  });
  expect(compared(clear, others, NONE)).toEqual({ sentence: said });
});
