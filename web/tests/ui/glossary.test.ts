import { readdirSync, readFileSync } from "node:fs";
import { describe, expect, it } from "vitest";
import { entriesOf, GLOSSARY } from "../../src/ui/glossary";

const SOURCES = new URL("../../src/", import.meta.url);

describe("the glossary", () => {
  it("is read from its document, lines joined", () => {
    expect(entriesOf("## A\n\n- **one**: First.\n- **two**: Second *part*,\n  and more.\n")).toEqual(
      new Map([
        ["one", "First."],
        ["two", "Second part, and more."],
      ]),
    );
    expect(GLOSSARY.size).toBeGreaterThan(25);
  });

  it("says everything in short sentences", () => {
    for (const [term, meaning] of GLOSSARY)
      for (const sentence of meaning.split(/[.:] /))
        expect(sentence.split(" ").length, `${term}: ${sentence}`).toBeLessThanOrEqual(25);
  });

  it("has every term that the page explains", () => {
    const files = readdirSync(SOURCES, { recursive: true, encoding: "utf8" }).filter((name) =>
      /\.(svelte|ts)$/.test(name),
    );
    const texts = files.map((name) => readFileSync(new URL(name, SOURCES), "utf8"));
    const used = texts.flatMap((text) =>
      [...text.matchAll(/<Term name="([^"]+)"|\bterm: "([^"]+)"/g)].map((match) => match[1] ?? match[2]!),
    );
    expect(used.length).toBeGreaterThan(8);
    expect(used.filter((term) => !GLOSSARY.has(term))).toEqual([]);
  });
});
