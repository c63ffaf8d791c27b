/** The participant's screen: what can be answered when, and where a card is kept. */

// @vitest-environment jsdom
import { beforeEach, describe, expect, it } from "vitest";
import type { StudyTask } from "../../src/net/messages";
import { Draft } from "../../src/pages/study/answer";
import { read } from "../../src/pages/study/form";
import { keepCard, keptCard } from "../../src/pages/study/keep";
import { clock } from "../../src/pages/study/rest";
import { languageName, type Word, word } from "../../src/pages/study/words";

const SCALE = { name: "realism", question: "How realistic is it?", low: "", high: "", points: 7 };
const TASK: StudyTask = {
  number: 3,
  at: 2,
  of: 36,
  item: "MX Clear",
  question: "Which?",
  places: ["X", "A", "B"],
  choices: ["A", "B"],
  equal: "equally close",
  rated: ["A", "B"],
  scales: [SCALE],
};

function felt(task = TASK, ...labels: string[]): Draft {
  const draft = new Draft(task);
  for (const label of labels) draft.pressed(label);
  return draft;
}

describe("an answer", () => {
  it("is complete once every label was pressed, one is chosen and each is rated", () => {
    const draft = felt(TASK, "X", "A");
    draft.choose("B");
    draft.rate("realism", "A", 3);
    draft.rate("realism", "B", 7);
    expect(draft.complete()).toBe(false);
    expect(draft.unfelt()).toEqual(["B"]);
    draft.pressed("B");
    expect(draft.complete()).toBe(true);
    expect(draft.ratings()).toEqual({ realism: { A: 3, B: 7 } });
  });

  it("takes no choice that is not offered", () => {
    const draft = felt();
    expect(draft.choose("X")).toBe(false);
    expect(draft.choose("equal")).toBe(true);
    expect(new Draft({ ...TASK, equal: "" }).choose("equal")).toBe(false);
  });

  it("of ratings only needs no choice", () => {
    const draft = felt({ ...TASK, choices: [], equal: "", places: ["X", "A", "B"] }, "X", "A", "B");
    draft.rate("realism", "A", 1);
    draft.rate("realism", "B", 1);
    expect(draft.complete()).toBe(true);
  });

  it("rates what is under the finger by a digit, one scale after the other", () => {
    const draft = felt({ ...TASK, scales: [SCALE, { ...SCALE, name: "crisp" }] });
    expect(draft.rateFelt("X", 4)).toBe(false);
    expect(draft.rateFelt("A", 8)).toBe(false);
    expect(draft.rateFelt("A", 4)).toBe(true);
    expect(draft.rateFelt("A", 5)).toBe(true);
    expect(draft.rateFelt("A", 6)).toBe(true);
    expect(draft.ratings()).toEqual({ realism: { A: 4 }, crisp: { A: 6 } });
  });

  it("leaves a slider to its own keys", () => {
    expect(felt({ ...TASK, scales: [{ ...SCALE, points: 101 }] }).rateFelt("A", 4)).toBe(false);
  });
});

describe("a card", () => {
  beforeEach(() => sessionStorage.clear());
  const CARD = { person: "P01", code: "ABCD", language: "fi", noted: true };

  it("is kept for its seat in this tab, and nowhere else", () => {
    keepCard("mine", "one", CARD);
    expect(keptCard("mine", "one")).toEqual(CARD);
    expect(keptCard("mine", "two")).toBeNull();
    expect(keptCard("other", "one")).toBeNull();
    expect(localStorage.length).toBe(0);
    expect(document.cookie).toBe("");
    keepCard("mine", "one", null);
    expect(sessionStorage.length).toBe(0);
  });
});

describe("words", () => {
  const LANGUAGES = ["en", "de", "fi", "fr", "zh"];
  const KEYS: readonly Word[] = [
    "begin",
    "cardText",
    "trial",
    "keys",
    "lost",
    "leaveSure",
    "breakLeft",
    "number",
  ];

  it.each(LANGUAGES)("of %s are its own, with the same places", (language) => {
    const places = (text: string) => text.split("|").length;
    for (const key of KEYS) {
      const filled = {
        at: "|",
        of: "|",
        places: "|",
        digits: "|",
        choices: "|",
        time: "|",
        low: "|",
        high: "|",
      };
      expect(places(word(language, key, filled))).toBe(places(word("en", key, filled)));
      if (language !== "en") expect(word(language, key)).not.toBe(word("en", key));
    }
    expect(languageName(language)).not.toBe(language);
  });

  it("are English where a language is not known, and of the language where a country is named", () => {
    expect(word("tlh", "next")).toBe("Next");
    expect(word("de-AT", "next")).toBe("Weiter");
  });
});

it("what is left of a break is shown in minutes and seconds", () => {
  expect([180, 61.2, 59.01, 0, -3].map(clock)).toEqual(["3:00", "1:02", "1:00", "0:00", "0:00"]);
});

describe("what is filled in", () => {
  const AGE = { name: "age", question: "How old?", required: true, choices: [], low: 18, high: 99 };
  it("is a number within its range, written with a point or a comma", () => {
    expect(read(AGE, " 18,5 ")).toBe(18.5);
    expect([read(AGE, "17"), read(AGE, "100"), read(AGE, "old"), read(AGE, " ")]).toEqual(
      Array(4).fill(undefined),
    );
  });
  it("may be left out where it is not required", () => {
    expect(read({ ...AGE, required: false }, "")).toBeNull();
    expect(read({ ...AGE, low: null, high: null }, " text ")).toBe("text");
  });
});
