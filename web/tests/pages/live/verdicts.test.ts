import { describe, expect, it, vi } from "vitest";
import type { JobOutcome, JobRow, PressSeen } from "../../../src/net";
import type { Status } from "../../../src/pages/live/looking";
import { emptyPicture } from "../../../src/pages/live/picture";
import { deviceVerdict, jobVerdict, leftText, runningLine } from "../../../src/pages/live/verdicts";

const row: JobRow = {
  job: "0001",
  kind: "compensate",
  title: "Compensate mx-clear on twin",
  device: "twin",
  simulated: true,
  state: "running",
  line: "",
  now: "",
  done: 11,
  total: 24,
  events: 1,
  resumable: false,
  created: "",
  ended: null,
  results: [],
  button: "builtin:mx-clear",
  stage: "compensate",
};
const curve = {
  stroke: "press",
  velocity_mm_s: 200,
  displacement_mm: [],
  noticed_ratio: [],
  total_ratio: 0,
  vibration: "",
  before_ratio: 0.9,
} as const;
const probed = (force_ratio: number, before_ratio: number | null = 0.9): JobOutcome => ({
  type: "outcome",
  stage: "probe",
  sentence: "a sentence",
  headline: "Mean error 14 → 0.7 cN",
  presses: 1,
  skipped: 0,
  simulated: true,
  noticed: [{ ...curve, force_ratio, before_ratio }],
});
const over = (outcome: JobOutcome, more: Partial<JobRow> = {}) =>
  jobVerdict(
    { ...row, state: "done", ...more },
    { ...emptyPicture(), outcomes: [outcome] },
    0,
    () => undefined,
  );

describe("a job that is under way", () => {
  it("says what it does, and how long that still takes", () => {
    expect(runningLine(row, 41)).toBe("Learning: press 12 of 24, about 40 s left.");
    expect(runningLine({ ...row, stage: "", total: 0 }, 9)).toBe("Starting, about 10 s left.");
  });

  it("says times as people do, and never that none is left", () => {
    expect([-3, 0, 41, 200].map(leftText)).toEqual([
      "a few seconds",
      "a few seconds",
      "about 40 s",
      "about 3 min",
    ]);
  });
});

describe("a job that is over", () => {
  it("ends with the server's headline; what is simulated is pressed next", () => {
    expect(over(probed(0))).toEqual({
      sentence: "Mean error 14 → 0.7 cN.",
      kind: "good",
      next: { label: "Press it", to: "#/press/builtin%3Amx-clear" },
    });
    const [slow, fast] = [
      probed(0).noticed,
      probed(0.9).noticed?.map((one) => ({ ...one, velocity_mm_s: 300 })),
    ];
    expect(over({ ...probed(0), noticed: [...(slow ?? []), ...(fast ?? [])] })?.kind).toBe("good");
    // as the headline: what is noticed of one stroke is noticed at its speed
    const both = [...(probed(0).noticed ?? []), ...(probed(0.9).noticed ?? [])];
    expect(over({ ...probed(0), noticed: both })?.kind).toBe("warning");
  });

  it("leads to people where a real rig was pressed, and to compensation where there was none", () => {
    expect(over(probed(0), { simulated: false })?.next?.label).toBe("Start a study");
    expect(over(probed(0.9, null))?.next?.to).toBe("#/live/compensate?button=builtin%3Amx-clear");
  });

  it("can go on where it was stopped", () => {
    const resume = vi.fn();
    const found = { ...row, state: "cancelled", line: "stopped", resumable: true } as const;
    const verdict = jobVerdict(found, emptyPicture(), 0, resume);
    expect(verdict?.sentence).toBe("Stopped (11 of 24).");
    verdict?.next?.act?.();
    expect(resume).toHaveBeenCalledOnce();
  });

  it("opens the button that a capture made", () => {
    const captured: JobOutcome = {
      ...probed(0),
      stage: "capture",
      sentence: "a model of 4 curves",
      headline: "",
    };
    const results = [{ kind: "button", name: "mine" }] as const;
    const verdict = over(captured, { kind: "capture", results });
    expect(verdict?.sentence).toBe("A model of 4 curves, simulated.");
    expect(verdict?.next).toEqual({ label: "Edit it", to: "#/edit/own%3Amine" });
  });
});

describe("a device", () => {
  const acts = { upload: vi.fn(), press: vi.fn(), arm: vi.fn(), clear: vi.fn(), checkCell: vi.fn() };
  const status: Status = {
    type: "standing",
    device: "host",
    name: "host",
    simulated: true,
    streams: true,
    person: false,
    force_sensor: true,
    tick_s: 1e-4,
    mode: "idle",
    programmed: "mx-clear",
    travel_mm: 4,
    fault: "",
    loop: "closed",
    missing_ticks: 0,
    late_ticks: 0,
    missing_frames: 0,
    lost_records: 0,
  };
  const seen = { sentence: "Mean error 8.6 cN", noticed: true } as PressSeen;
  const next = (more: Partial<Status>, press: PressSeen | null = null, learned = false) =>
    deviceVerdict({ ...status, ...more }, press, "builtin:mx-clear", learned, acts)?.next?.label;

  it("is led from upload to press, and from there to compensation or a study", () => {
    expect(next({ programmed: "" })).toBe("Upload");
    expect(next({})).toBe("Press once");
    expect(next({}, seen)).toBe("Compensate it");
    expect(next({}, seen, true)).toBe("Start a study");
    expect(next({ person: true })).toBe("Arm");
    expect(next({ person: true, mode: "armed" })).toBeUndefined();
  });

  it("comes first with what went wrong", () => {
    expect(next({ fault: "position stuck" }, seen)).toBe("Clear the fault");
    expect(next({ loop: "failed, cell_wrong" }, seen)).toBe("Check the cell");
    expect(next({ device: "" })).toBeUndefined();
  });
});
