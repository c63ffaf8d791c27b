/** What a job's events come to: everything its views draw. Folded event by event, so that a reload gives the same. */

import type {
  CueStarted,
  CurveIntended,
  CurveProgress,
  JobEvents,
  JobOutcome,
  PaceProgress,
  PressAsked,
  PressEvent,
  QuestionAsked,
  TakeAsked,
  TakeEvent,
  TuneRanking,
} from "../../net";

export type JobEvent = JobEvents["events"][number];

/** A press and its number among all of the job, from 1. */
export interface NumberedPress {
  readonly number: number;
  readonly press: PressEvent;
}

export interface JobPicture {
  device: string;
  simulated: boolean;
  stage: string;
  readonly notices: string[];
  /** By speed, mm/s. */
  readonly intended: Map<number, CurveIntended>;
  readonly presses: NumberedPress[];
  /** The newest standing of each curve, by curveKey. */
  readonly curves: Map<string, CurveProgress>;
  readonly outcomes: JobOutcome[];
  pressAsked: PressAsked | null;
  takeAsked: TakeAsked | null;
  /** Counts the cues that began: a change means that one begins now. */
  cues: number;
  readonly takes: TakeEvent[];
  paces: readonly PaceProgress[];
  question: QuestionAsked | null;
  answers: number;
  rankings: readonly TuneRanking[];
}

export type Stage = PressEvent["stage"];
export type StrokeName = CurveProgress["stroke"];

export function emptyPicture(): JobPicture {
  return {
    device: "",
    simulated: false,
    stage: "",
    notices: [],
    intended: new Map(),
    presses: [],
    curves: new Map(),
    outcomes: [],
    pressAsked: null,
    takeAsked: null,
    cues: 0,
    takes: [],
    paces: [],
    question: null,
    answers: 0,
    rankings: [],
  };
}

export function curveKey(stage: string, stroke: StrokeName, velocity_mm_s: number): string {
  return `${stage} ${stroke} ${velocity_mm_s}`;
}

/** Take one event into the picture. */
export function fold(picture: JobPicture, event: JobEvent): void {
  switch (event.type) {
    case "begun":
      picture.device = event.device;
      picture.simulated = event.simulated;
      break;
    case "stage":
      picture.stage = event.stage;
      break;
    case "notice":
      picture.notices.push(event.text);
      break;
    case "intended":
      picture.intended.set(event.velocity_mm_s, event);
      break;
    case "outcome":
      foldOutcome(picture, event);
      break;
    case "ended":
      settle(picture);
      break;
    default:
      foldStep(picture, event);
  }
}

type Step =
  | PressAsked
  | PressEvent
  | TakeAsked
  | CueStarted
  | TakeEvent
  | QuestionAsked
  | Extract<JobEvent, { type: "answered" }>;

function foldStep(picture: JobPicture, event: Step): void {
  switch (event.type) {
    case "press_asked":
      picture.pressAsked = event;
      break;
    case "press":
      foldPress(picture, event);
      break;
    case "take_asked":
      picture.takeAsked = event;
      break;
    case "cue":
      picture.cues += 1;
      break;
    case "take":
      picture.takes.push(event);
      picture.paces = event.paces;
      picture.takeAsked = null;
      break;
    case "asked":
      picture.question = event;
      break;
    case "answered":
      picture.question = null;
      picture.answers = event.number;
      picture.rankings = event.rankings;
  }
}

function foldPress(picture: JobPicture, press: PressEvent): void {
  picture.pressAsked = null;
  picture.presses.push({ number: picture.presses.length + 1, press });
  keep(picture, press.stage, press.curves);
}

function foldOutcome(picture: JobPicture, outcome: JobOutcome): void {
  const others = picture.outcomes.filter((one) => one.stage !== outcome.stage);
  picture.outcomes.splice(0, picture.outcomes.length, ...others, outcome);
  keep(picture, outcome.stage, outcome.curves ?? []);
  if (outcome.rankings?.length) picture.rankings = outcome.rankings;
}

function keep(picture: JobPicture, stage: string, curves: readonly CurveProgress[]): void {
  for (const curve of curves) picture.curves.set(curveKey(stage, curve.stroke, curve.velocity_mm_s), curve);
}

/** Nothing waits for a person once the work is over. */
function settle(picture: JobPicture): void {
  picture.pressAsked = null;
  picture.takeAsked = null;
  picture.question = null;
}
