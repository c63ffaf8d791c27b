import { readFileSync } from "node:fs";
import { describe, expect, it } from "vitest";
import { between, partOf } from "../../src/draw/velocity";

const TOKENS = readFileSync(new URL("../../src/tokens.css", import.meta.url), "utf8");
const [LIGHT, DARK] = TOKENS.split('[data-theme="dark"]') as [string, string];

function token(theme: string, name: string): string {
  return new RegExp(`--${name}: (#[0-9a-f]{6});`).exec(theme)![1]!;
}

function luminance(colour: string): number {
  const [r, g, b] = [1, 3, 5].map((at) => {
    const c = Number.parseInt(colour.slice(at, at + 2), 16) / 255;
    return c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4;
  }) as [number, number, number];
  return 0.2126 * r + 0.7152 * g + 0.0722 * b;
}

function contrast(a: string, b: string): number {
  const [low, high] = [luminance(a), luminance(b)].sort((x, y) => x - y) as [number, number];
  return (high + 0.05) / (low + 0.05);
}

describe.each([
  ["light", LIGHT],
  ["dark", DARK],
])("the scale of velocity, %s", (_name, theme) => {
  const stops = [1, 2, 3, 4, 5].map((n) => token(theme, `velocity-${n}`));
  const surface = token(theme, "surface");
  const speeds = Array.from({ length: 101 }, (_, i) => 5 * i);
  const contrasts = speeds.map((v) => contrast(between(stops, partOf(v)), surface));

  it("stands out from the surface at every speed", () => {
    expect(Math.min(...contrasts)).toBeGreaterThan(3);
  });

  it("stands out more the faster it is, whatever colours an eye can see", () => {
    for (let i = 1; i < contrasts.length; i++)
      expect(contrasts[i]!).toBeGreaterThanOrEqual(contrasts[i - 1]! - 0.05);
  });

  it("ends at its last colour, for faster presses too", () => {
    expect(between(stops, partOf(2000))).toBe(stops[4]);
    expect(between(stops, partOf(0))).toBe(stops[0]);
  });
});
