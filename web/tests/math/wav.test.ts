import { expect, test } from "vitest";
import { wavOf } from "../../src/math/wav";

test("a sound is written as a WAV file of 16 bits and one channel", () => {
  const view = new DataView(wavOf(Float32Array.of(0, 1, -1, 2), 8000, "int16"));
  expect(view.byteLength).toBe(44 + 8);
  expect([view.getUint16(22, true), view.getUint32(24, true), view.getUint16(34, true)]).toEqual([
    1, 8000, 16,
  ]);
  expect([0, 1, 2, 3].map((i) => view.getInt16(44 + 2 * i, true))).toEqual([0, 32767, -32767, 32767]);
});
