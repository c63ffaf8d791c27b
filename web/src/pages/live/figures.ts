/** Tables of a job's figures: heads, and rows whose first cell names them. */

import type { CurveNoticed, CurveProgress, PaceProgress, TakeEvent, TuneRanking } from "../../net";
import { forceUnit, inUnit, withForces } from "../../ui/force";
import type { NumberedPress, StrokeName } from "./picture";

export interface Figures {
  readonly heads: readonly string[];
  readonly rows: readonly (readonly (string | number)[])[];
}

const NOT_ASKED = "not asked for";
const PARTS = { compensate: "learn", baseline: "uncompensated", probe: "evaluate" } as const;
const STEPS = { rest: "at rest", probe: "slow probe", press: "" } as const;

const fixed = (value: number | null | undefined, digits: number) => value?.toFixed(digits) ?? "–";
const inForce = (label: string) => `${label}, ${forceUnit()}`;
const errorText = (cN: number | null | undefined, digits: number) =>
  typeof cN === "number" ? inUnit(cN, "cN", digits) : "–";
const curveName = (curve: { velocity_mm_s: number; stroke: string }) =>
  `${curve.velocity_mm_s} mm/s ${curve.stroke}`;

export function errorRows(curves: readonly CurveProgress[]): Figures {
  const sorted = [...curves].sort(
    (a, b) => a.velocity_mm_s - b.velocity_mm_s || a.stroke.localeCompare(b.stroke),
  );
  return {
    heads: ["curve", "presses", ...["first", "last", "mean", "largest"].map(inForce)],
    rows: sorted.map((c) => [
      curveName(c),
      c.error_cN.length,
      ...[c.error_cN[0], c.error_cN.at(-1), c.mean_error_cN, c.max_error_cN].map((cN) => errorText(cN, 2)),
    ]),
  };
}

/** How much of each curve a finger would notice, and how the vibration came out. */
export function noticedRows(curves: readonly CurveNoticed[]): Figures {
  const percent = (ratio: number | null | undefined) =>
    typeof ratio === "number" ? `${Math.round(100 * ratio)} %` : "";
  const error = (cN: number | null | undefined) => (typeof cN === "number" ? errorText(cN, 1) : "");
  const fell = (...texts: string[]) => texts.filter(Boolean).join(" → ") || "–";
  const vibrates = curves.some(({ vibration }) => vibration !== NOT_ASKED);
  return {
    heads: [
      "curve",
      "noticed",
      inForce("mean error"),
      inForce("largest"),
      ...(vibrates ? ["noticed with vibration", "vibration"] : []),
    ],
    rows: curves.map((c) => [
      curveName(c),
      fell(percent(c.before_ratio), percent(c.force_ratio)),
      fell(error(c.before_mean_cN), error(c.mean_cN)),
      fell(error(c.before_max_cN), error(c.max_cN)),
      ...(vibrates ? [percent(c.total_ratio), c.vibration] : []),
    ]),
  };
}

export function pressRows(presses: readonly NumberedPress[]): Figures {
  return {
    heads: [
      "press",
      "part",
      "speed, mm/s",
      "achieved, mm/s",
      inForce("error down"),
      inForce("error up"),
      "outcome",
    ],
    rows: presses.map(({ number, press }) => {
      const error = (stroke: StrokeName) =>
        press.skipped
          ? "–"
          : errorText(press.curves.find((curve) => curve.stroke === stroke)?.error_cN.at(-1), 2);
      const said = press.skipped ? `rejected: ${press.skipped}` : withForces(press.told);
      const achieved = fixed(press.achieved_mm_s, 0);
      return [
        number,
        PARTS[press.stage],
        press.velocity_mm_s,
        achieved,
        error("press"),
        error("release"),
        said,
      ];
    }),
  };
}

function median(values: readonly number[]): number | undefined {
  const sorted = [...values].sort((a, b) => a - b);
  const [low, high] = [sorted[(sorted.length - 1) >> 1], sorted[sorted.length >> 1]];
  return low === undefined || high === undefined ? undefined : (low + high) / 2;
}

export function paceRows(paces: readonly PaceProgress[]): Figures {
  return {
    heads: ["speed", "good", "of", "takes", "missed", "median, mm/s", "least", "most"],
    rows: paces.map(({ velocity_mm_s, good, wanted, made, missed, achieved_mm_s: speeds }) => {
      const extremes = speeds.length
        ? [median(speeds), Math.min(...speeds), Math.max(...speeds)]
        : [null, null, null];
      return [`${velocity_mm_s} mm/s`, good, wanted, made, missed, ...extremes.map((v) => fixed(v, 1))];
    }),
  };
}

export function takeRows(takes: readonly TakeEvent[]): Figures {
  return {
    heads: ["take", "asked", "achieved, mm/s", "travel, mm", "outcome"],
    rows: takes.map((take) => [
      take.number,
      STEPS[take.step] || `${take.velocity_mm_s ?? "?"} mm/s`,
      fixed(take.achieved_mm_s, 0),
      fixed(take.travel_mm, 2),
      take.ok ? "good" : `${take.reason}${take.missed ? "; too many tries, skipped" : ""}`,
    ]),
  };
}

export function rankingRows({ candidates }: TuneRanking): Figures {
  return {
    heads: ["vibration", "Hz", "m/s²", "score", "standard error", "outcome"],
    rows: [...candidates]
      .sort((a, b) => b.score - a.score)
      .map((one) => [
        one.name,
        fixed(one.frequency_Hz, 0),
        fixed(one.amplitude_m_s2, 1),
        fixed(one.score, 2),
        fixed(one.error, 2),
        one.best ? "kept" : one.alike ? "tied with the best" : "",
      ]),
  };
}
