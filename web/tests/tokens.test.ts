/** Colours have names: they are chosen in tokens.css, for both themes, and nowhere else. */

import { readdirSync, readFileSync } from "node:fs";
import { expect, it } from "vitest";

const SOURCES = new URL("../src/", import.meta.url);
const RAW = /(?<![\w&/])#(?:[0-9a-f]{3,4}|[0-9a-f]{6}|[0-9a-f]{8})\b|\b(?:rgb|hsl|oklch|lab)a?\(/gi;

function raw(text: string): string[] {
  return text.match(RAW) ?? [];
}

it("no source but the tokens names a colour by its numbers", () => {
  const files = readdirSync(SOURCES, { recursive: true, encoding: "utf8" }).filter((name) =>
    /\.(ts|svelte|css)$/.test(name),
  );
  expect(files.length).toBeGreaterThan(200);
  const found = files
    .filter((name) => name !== "tokens.css" && name !== "net/messages.ts")
    .flatMap((name) =>
      raw(readFileSync(new URL(name, SOURCES), "utf8")).map((colour) => `${name}: ${colour}`),
    );
  expect(found).toEqual([]);
});

it("colours are found where they are", () => {
  expect(raw("color: #fff; background: rgb(1 2 3); border: 1px solid #A0b1c2")).toHaveLength(3);
  expect(raw("#/edit/own:x, &#123;, #region, color-mix(in srgb, var(--a), var(--b))")).toEqual([]);
});

it("the dark theme has every colour of the light one", () => {
  const text = readFileSync(new URL("tokens.css", SOURCES), "utf8");
  const [light, dark] = text.split('[data-theme="dark"]') as [string, string];
  const names = (part: string) => [...part.matchAll(/(--[\w-]+): (?:#|rgb)/g)].map((match) => match[1]);
  expect(names(dark)).toEqual(names(light));
});
