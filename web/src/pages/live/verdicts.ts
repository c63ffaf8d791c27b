/** What a job or a device comes to, in one sentence, and the one thing to do next. */

import { address } from "../../app/route";
import type { Step, Verdict } from "../../app/verdict";
import type { CurveNoticed, JobOutcome, JobRow, PressSeen } from "../../net";
import type { Status } from "./looking";
import type { JobPicture } from "./picture";
import { isUnderWay } from "./picture";

const DOING: Readonly<Record<string, string>> = {
  baseline: "Pressing without compensation",
  compensate: "Learning",
  probe: "Judging on held-out presses",
  capture: "Recording",
  process: "Making a model of the recording",
  tune: "Comparing vibrations",
};
const COUNTED = { compensate: "press", probe: "press", capture: "take", tune: "question" } as const;
/** Less of a stroke than that above one JND counts as little, as in fdvv.rendering.evaluation.verdict. */
const FEW_ratio = 0.1;

/** About how long, as people say it. */
export function leftText(left_s: number): string {
  if (left_s < 5) return "a few seconds";
  if (left_s < 90) return `about ${5 * Math.round(left_s / 5)} s`;
  return `about ${Math.round(left_s / 60)} min`;
}

/** What a job that is under way does, and how long it still takes. */
export function runningLine(row: JobRow, left_s: number): string {
  const [doing, left] = [DOING[row.stage ?? ""] ?? "Starting", `${leftText(left_s)} left`];
  const number = `${COUNTED[row.kind]} ${Math.min(row.done + 1, row.total)} of ${row.total}`;
  return `${row.total ? `${doing}: ${number}` : doing}, ${left}.`;
}

const pressIt = (button: string): Step => ({ label: "Press it", to: address("press", button) });
const study = (button: string): Step => ({ label: "Start a study", to: address("studies", "", { button }) });
const compensate = (button: string): Step => ({
  label: "Compensate it",
  to: address("live", "compensate", { button }),
});

export function jobVerdict(
  row: JobRow,
  picture: JobPicture,
  left_s: number,
  resume: () => void,
): Verdict | null {
  if (isUnderWay(row)) return { sentence: runningLine(row, left_s) };
  if (row.state !== "done") {
    const next = { label: "Resume", act: resume };
    return { sentence: ended(row), kind: "warning", ...(row.resumable && { next }) };
  }
  const found = picture.outcomes.at(-1);
  if (!found) return null;
  const made = row.results.find(({ kind }) => kind === "button");
  if (found.stage === "probe" || found.stage === "compensate") return rendered(row, found);
  const own = made ? `own:${made.name}` : "";
  const sentence = `${found.sentence[0]?.toUpperCase()}${found.sentence.slice(1)}${row.simulated ? ", simulated" : ""}.`;
  const next = row.kind === "capture" ? { label: "Edit it", to: address("edit", own) } : pressIt(own);
  return { sentence, kind: found.warnings?.length ? "warning" : "good", ...(own && { next }) };
}

/** Why a job was not finished. */
function ended({ line, done, total }: JobRow): string {
  return `${line[0]?.toUpperCase() ?? ""}${line.slice(1)}${total ? ` (${done} of ${total})` : ""}.`;
}

/** The server's headline; what to do next depends on whether it can be felt. */
function rendered(row: JobRow, found: JobOutcome): Verdict {
  const curves = found.noticed ?? [];
  const speeds = (of: readonly CurveNoticed[]) => new Set(of.map(({ velocity_mm_s }) => velocity_mm_s)).size;
  const felt = curves.filter(({ force_ratio }) => force_ratio > FEW_ratio);
  const bare = curves.length > 0 && curves.every((curve) => typeof curve.before_ratio !== "number");
  const next = bare
    ? compensate(row.button ?? "")
    : row.simulated
      ? pressIt(row.button ?? "")
      : study(row.button ?? "");
  const kind = curves.length && speeds(felt) === speeds(curves) ? "warning" : "good";
  return { sentence: `${found.headline || found.sentence}.`, kind, ...(row.button && { next }) };
}

export type DeviceActs = Readonly<Record<"upload" | "press" | "arm" | "clear" | "checkCell", () => void>>;

/** button : that is chosen. learned : the device renders a learned table. */
export function deviceVerdict(
  status: Status,
  seen: PressSeen | null,
  button: string,
  learned: boolean,
  acts: DeviceActs,
): Verdict | null {
  const { device, fault, loop, programmed, person, mode } = status;
  const simulated = status.simulated ? ", simulated" : "";
  if (fault) {
    const next = { label: "Clear the fault", act: acts.clear };
    return { sentence: `Zero force: ${fault}.`, kind: "warning", ...(device && { next }) };
  }
  if (!device) return null;
  if (loop.startsWith("failed")) {
    const why = loop.replace("failed, ", "").replaceAll("_", " ");
    const sentence = `The force loop opened, ${why}: tables render until the load cell is checked.`;
    return { sentence, kind: "warning", next: { label: "Check the cell", act: acts.checkCell } };
  }
  if (!programmed) {
    return {
      sentence: `${device} is connected${simulated}, without a button.`,
      next: { label: "Upload", act: acts.upload },
    };
  }
  if (seen) {
    const next = seen.noticed && !learned ? compensate(button) : study(button);
    return { sentence: `${seen.sentence}.`, kind: seen.noticed ? "warning" : "good", next };
  }
  if (!person)
    return {
      sentence: `${programmed} is on ${device}${simulated}.`,
      next: { label: "Press once", act: acts.press },
    };
  if (mode === "armed") return { sentence: `${programmed} is rendered: press it.` };
  return { sentence: `${programmed} is on ${device}.`, next: { label: "Arm", act: acts.arm } };
}
