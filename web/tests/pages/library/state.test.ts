import { describe, expect, it } from "vitest";
import {
  AT_FIRST,
  EVERYTHING,
  MOST,
  type Query,
  readState,
  type Shown,
  writeState,
} from "../../../src/pages/library/state";

const read = (text: string) => readState(new URLSearchParams(text));

describe("the address of a view", () => {
  it("is empty where nothing was chosen", () => {
    expect(writeState(EVERYTHING, AT_FIRST).toString()).toBe("");
    expect(read("")).toEqual({ query: EVERYTHING, shown: AT_FIRST });
  });

  it("shows the same view again", () => {
    const query: Query = {
      text: "cherry & co = 5%",
      kinds: ["tactile", "clicky?"],
      origins: ["measured"],
      ranges: {
        peak_cN: { low: 40, high: 60.5 },
        snap_ratio: { low: null, high: 0.3 },
        pre_slope_cN_mm: { low: -1, high: null },
      },
      like: "measured:0123456789abcdef",
      sort: "drop_cN",
      descending: true,
    };
    const shown: Shown = {
      overlay: ["builtin:mx-clear", "own:a,b", "measured:0123456789abcdef"],
      reference: "own:a,b",
      view: "slope",
      tab: "alike",
      press: true,
      release: false,
      marks: false,
      loss: true,
      velocity_mm_s: 150,
    };
    expect(read(writeState(query, shown).toString())).toEqual({ query, shown });
  });

  it("takes what is wrong in it as if it were not there", () => {
    const { query, shown } = read(
      "kind=round,linear&from=moon&peak_cN=a..b&__proto__=1..2&view=sound&tab=x&speed=-3&ref=own:none&over=own:a&press=2",
    );
    expect(query).toEqual({ ...EVERYTHING, kinds: ["linear"] });
    expect(shown).toEqual({ ...AT_FIRST, overlay: ["own:a"], reference: "own:a", press: false });
  });

  it("holds each button once, and no more than can be asked for", () => {
    const many = Array.from({ length: 200 }, (_, i) => `over=own:${i % 150}`).join("&");
    const { overlay } = read(many).shown;
    expect(overlay).toHaveLength(MOST);
    expect(new Set(overlay).size).toBe(MOST);
  });
});
