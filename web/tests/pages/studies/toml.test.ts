import { readdirSync, readFileSync } from "node:fs";
import { expect, test } from "vitest";
import { readValue, writeValue } from "../../../src/pages/studies/toml";

const FOLDER = "../packages/fdvv-people/src/fdvv_people/study/templates";
const TEXT = `people = 12   # planned
rounds = 6
switch_s = 0.6
ties = true
title.en = "before"
[title]
en = "How \\"real\\"?" # asked
[claim]
alpha = 0.05
[[items]]
people = 99
`;

test("a value is read from its own table", () => {
  expect(readValue(TEXT, "", "people")).toBe(12);
  expect(readValue(TEXT, "title", "en")).toBe('How "real"?');
  expect(readValue(TEXT, "claim", "alpha")).toBe(0.05);
  expect(readValue(TEXT, "", "ties")).toBe(true);
  expect(readValue(TEXT, "claim", "people")).toBeNull();
});

test("only the value changes: comments and all other lines stay", () => {
  expect(writeValue(TEXT, "", "people", 24)).toBe(TEXT.replace("people = 12", "people = 24"));
  expect(writeValue(TEXT, "title", "en", "New")).toBe(TEXT.replace('"How \\"real\\"?"', '"New"'));
  expect(writeValue(TEXT, "", "switch_s", 1)).toBe(TEXT.replace("0.6", "1.0"));
  expect(writeValue(TEXT, "", "nothing", 1)).toBe(TEXT);
});

test("what is written is read again, and what is written back is the text as it was", () => {
  for (const file of readdirSync(FOLDER).filter((name) => name.endsWith(".toml"))) {
    const text = readFileSync(`${FOLDER}/${file}`, "utf8");
    for (const [table, key, value] of [
      ["", "people", 31],
      ["", "rounds", 3],
      ["", "break_min", 2],
      ["exclusion", "error_cN", 12.5],
      ["title", "en", 'a "quoted" \\ title'],
    ] as const) {
      const before = readValue(text, table, key);
      if (before === null) continue;
      const changed = writeValue(text, table, key, value);
      expect(readValue(changed, table, key)).toBe(value);
      expect(writeValue(changed, table, key, before)).toBe(text);
    }
  }
});
