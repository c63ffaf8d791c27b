/** The presses, newest first, with the reason of each that was not used. */

import { type Child, h, signal, toggle } from "../../ui";
import { watched } from "./jobs";
import type { NumberedPress, StrokeName } from "./picture";

const SHOWN = 40;
const PARTS = { compensate: "learn", baseline: "uncompensated", probe: "evaluate" } as const;
const onlySkipped = signal(false);

export function pressTable(): Child {
  const rows = () => {
    const all = watched().picture.presses;
    const found = onlySkipped() ? all.filter((one) => one.press.skipped) : all;
    return found.slice(-SHOWN).reverse();
  };
  const heads = ["press", "part", "speed, mm/s", "achieved, mm/s", "error down, cN", "error up, cN"];
  return h(
    "div",
    { class: "stack" },
    h(
      "div",
      { class: "row spread" },
      h("span", { class: "muted" }, () => said()),
      toggle({
        label: "Only rejected presses",
        value: () => onlySkipped(),
        set: (on) => onlySkipped.set(on),
      }),
    ),
    h(
      "div",
      { class: "press-scroll", tabindex: 0, role: "region", "aria-label": "Presses" },
      h(
        "table",
        { "aria-label": "Presses, newest first" },
        h(
          "thead",
          {},
          h(
            "tr",
            {},
            heads.map((text, i) => h("th", { scope: "col", class: i === 1 ? "" : "number" }, text)),
            h("th", { scope: "col" }, "outcome"),
          ),
        ),
        h("tbody", {}, () => rows().map(line)),
      ),
    ),
  );
}

function said(): string {
  const all = watched().picture.presses;
  const skipped = all.filter((one) => one.press.skipped).length;
  const counted = `${all.length} ${all.length === 1 ? "press" : "presses"}`;
  return skipped ? `${counted}, ${skipped} rejected` : counted;
}

function line({ number, press }: NumberedPress): HTMLElement {
  const error = (stroke: StrokeName) => {
    const found = press.skipped
      ? undefined
      : press.curves.find((curve) => curve.stroke === stroke)?.error_cN.at(-1);
    return h("td", { class: "number" }, found === undefined ? "–" : found.toFixed(2));
  };
  return h(
    "tr",
    { class: press.skipped ? "skipped" : "" },
    h("td", { class: "number" }, number),
    h("td", {}, PARTS[press.stage]),
    h("td", { class: "number" }, press.velocity_mm_s),
    h("td", { class: "number" }, press.achieved_mm_s === null ? "–" : press.achieved_mm_s.toFixed(0)),
    error("press"),
    error("release"),
    h("td", {}, press.skipped ? `rejected: ${press.skipped}` : press.told),
  );
}
