import { describe, expect, it } from "vitest";
import { keyCode, keyName } from "../../src/keyboard/key_names";
import { FORMATS, formatOf, parseReport } from "../../src/keyboard/reports";

const named = (name: string) => FORMATS.find((format) => format.name === name)!;
const wooting1 = named("Wooting, interface 1");
const wooting2 = named("Wooting, interface 2");
const old = named("Wooting One or Two, old firmware");
const razer2 = named("Razer Huntsman Analog");
const razer3 = named("Razer Huntsman V3 Pro");

/** Bytes as they are written in hexadecimal, filled up with zeros. */
function bytes(hex: string, size = 0): DataView {
  const given = hex.split(" ").filter(Boolean);
  const all = new Uint8Array(Math.max(size, given.length));
  all.set(given.map((byte) => Number.parseInt(byte, 16)));
  return new DataView(all.buffer);
}

describe("a report of an analog keyboard", () => {
  it("of Wooting's first interface holds pairs of a big-endian code and a byte", () => {
    const { keys } = parseReport(wooting1, bytes("00 2c 80 00 04 ff 04 09 01", 48));
    expect(keys).toEqual([
      { code: 0x2c, ratio: 128 / 255 },
      { code: 0x04, ratio: 1 },
      { code: 0x409, ratio: 1 / 255 },
    ]);
  });

  it("names up to sixteen keys", () => {
    const hex = Array.from({ length: 16 }, (_, i) => `00 ${(4 + i).toString(16)} ${(16 + i).toString(16)}`);
    const { keys } = parseReport(wooting1, bytes(hex.join(" ")));
    expect(keys?.map(({ code }) => code)).toEqual(Array.from({ length: 16 }, (_, i) => 4 + i));
    expect(keys?.at(-1)?.ratio).toBe(31 / 255);
  });

  it("of a first Wooting is at the bottom at five sixths of the byte", () => {
    const ratio = (value: string) => parseReport(old, bytes(`00 2c ${value}`, 48)).keys?.[0]?.ratio;
    expect(ratio("6a")).toBeCloseTo((1.2 * 106) / 255, 12);
    expect(ratio("ff")).toBe(1);
  });

  it("of Wooting's second interface has ten bits of depth and the high bits of the code in between", () => {
    const { keys } = parseReport(wooting2, bytes("86 2c 41 80 00 09 d0 ff", 64));
    expect(keys).toEqual([
      { code: 0x2c, ratio: 513 / 1023 },
      { code: 0x409, ratio: 1 },
    ]);
  });

  it("of Razer has the maker's own codes, with a further byte from the third generation on", () => {
    expect(parseReport(razer2, bytes("3d 40 1f ff", 22), 7).keys).toEqual([
      { code: 0x3d, ratio: 64 / 255 },
      { code: 0x1f, ratio: 1 },
    ]);
    expect(parseReport(razer3, bytes("3d 40 07 1f ff 02", 45), 11).keys).toEqual([
      { code: 0x3d, ratio: 64 / 255 },
      { code: 0x1f, ratio: 1 },
    ]);
  });

  it("of zeros alone says that no key is down", () => {
    for (const format of FORMATS)
      expect(parseReport(format, bytes("", 48), format.reportId ?? 0).keys).toEqual([]);
  });

  it("that names a key twice, as old firmware does, means the last", () => {
    expect(parseReport(wooting1, bytes("00 2c 80 00 2c 90", 48)).keys).toEqual([
      { code: 0x2c, ratio: 0x90 / 255 },
    ]);
  });

  it("that is torn, empty or of another kind is left out with one line", () => {
    const problems = [
      parseReport(wooting1, bytes("00 2c 80 00 04")),
      parseReport(wooting2, bytes("86 2c 41 80 86")),
      parseReport(wooting1, bytes("")),
      parseReport(razer2, bytes("3d 40"), 9),
      parseReport(wooting1, bytes("7f 2c 80", 48)),
    ].map(({ problem }) => problem);
    expect(problems).toEqual([
      "a torn report was left out (5 bytes)",
      "a torn report was left out (5 bytes)",
      "an empty report was left out",
      "a report of an unknown kind was left out (number 9, 2 bytes)",
      "a report of an unknown kind was left out (it names key 32556)",
    ]);
  });

  it("of any bytes at all is read or left out, with depths from 0 to 1", () => {
    let state = 7;
    const random = () => {
      state = (state * 48271) % 2147483647;
      return state / 2147483647;
    };
    for (let i = 0; i < 5000; i++) {
      const format = FORMATS[Math.floor(random() * FORMATS.length)]!;
      const view = new DataView(
        Uint8Array.from({ length: Math.floor(random() * 65) }, () => Math.floor(random() * 256)).buffer,
      );
      const found = parseReport(format, view, random() < 0.8 ? (format.reportId ?? 0) : 3);
      if (found.problem !== undefined) expect(found.problem).not.toContain("\n");
      else for (const { ratio } of found.keys) expect(ratio >= 0 && ratio <= 1).toBe(true);
    }
  });
});

describe("a keyboard", () => {
  const device = (vendorId: number, productId: number, ...pages: number[]) =>
    formatOf({ vendorId, productId, collections: pages.map((usagePage) => ({ usagePage })) })?.name;

  it("is known by maker, product and usage page, whatever its mode", () => {
    expect(device(0x31e3, 0x1312, 0xff54)).toBe(wooting1.name);
    expect(device(0x31e3, 0x1322, 0xff54, 0xff53)).toBe(wooting2.name);
    expect(device(0x03eb, 0xff02, 0xff54)).toBe(old.name);
    expect(device(0x1532, 0x02a7, 0x0001)).toBe(razer3.name);
  });

  it("of another maker, or another interface of a known one, is not", () => {
    expect(device(0x31e3, 0x1312, 0x0001, 0xff55)).toBeUndefined();
    expect(device(0x03eb, 0x2042, 0xff54)).toBeUndefined();
    expect(device(0x046d, 0xc31c, 0xff54)).toBeUndefined();
  });
});

describe("the name of a key", () => {
  it("is the browser's, by its usage", () => {
    const usages = [0x04, 0x1d, 0x1e, 0x27, 0x28, 0x2c, 0x33, 0x45, 0x52, 0x64, 0xe7];
    expect(usages.map(keyCode).join(" ")).toBe(
      "KeyA KeyZ Digit1 Digit0 Enter Space Semicolon F12 ArrowUp IntlBackslash MetaRight",
    );
    expect([0x03, 0x32, 0x63, 0xe8, 0x409].map(keyCode)).toEqual(["", "", "", "", ""]);
  });

  it("is short for people, and a number where there is none", () => {
    expect(["KeyA", "Digit0", "ArrowUp", "F12"].map((code) => keyName(code, 1))).toEqual([
      "A",
      "0",
      "Arrow Up",
      "F12",
    ]);
    expect(keyName("", 0x3d)).toBe("key 61");
  });
});
