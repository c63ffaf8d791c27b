/** What a job's events come to: everything its views draw. Folded event by event, so that a reload gives the same. */

import type {
  CurveIntended,
  CurveProgress,
  JobEvents,
  JobOutcome,
  JobRow,
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

/** Nothing in it is ever changed: every event makes another one. */
export interface JobPicture {
  readonly stage: string;
  readonly notices: readonly string[];
  /** By speed, mm/s. */
  readonly intended: ReadonlyMap<number, CurveIntended>;
  readonly presses: readonly NumberedPress[];
  /** The newest standing of each curve, by curveKey. */
  readonly curves: ReadonlyMap<string, CurveProgress>;
  readonly outcomes: readonly JobOutcome[];
  readonly pressAsked: PressAsked | null;
  readonly takeAsked: TakeAsked | null;
  /** Counts the cues that began: a change means that one begins now. */
  readonly cues: number;
  readonly takes: readonly TakeEvent[];
  readonly paces: readonly PaceProgress[];
  readonly question: QuestionAsked | null;
  readonly rankings: readonly TuneRanking[];
}

export function isUnderWay(row: JobRow): boolean {
  return row.state === "waiting" || row.state === "running" || row.state === "needs you";
}

export type Stage = PressEvent["stage"];
export type StrokeName = CurveProgress["stroke"];

export function emptyPicture(): JobPicture {
  return {
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
    rankings: [],
  };
}

export function curveKey(stage: string, stroke: StrokeName, velocity_mm_s: number): string {
  return `${stage} ${stroke} ${velocity_mm_s}`;
}

/** Return the picture after an event. */
export function fold(picture: JobPicture, event: JobEvent): JobPicture {
  return { ...picture, ...changes(picture, event) };
}

function changes(picture: JobPicture, event: JobEvent): Partial<JobPicture> {
  switch (event.type) {
    case "begun":
      return {};
    case "stage":
      return { stage: event.stage };
    case "notice":
      return { notices: [...picture.notices, event.text] };
    case "intended":
      return { intended: new Map(picture.intended).set(event.velocity_mm_s, event) };
    case "press_asked":
      return { pressAsked: event };
    case "press": {
      const presses = [...picture.presses, { number: picture.presses.length + 1, press: event }];
      return { pressAsked: null, presses, curves: withCurves(picture, event.stage, event.curves) };
    }
    case "take_asked":
      return { takeAsked: event };
    case "cue":
      return { cues: picture.cues + 1 };
    case "take":
      return { takes: [...picture.takes, event], paces: event.paces, takeAsked: null };
    case "asked":
      return { question: event };
    case "answered":
      return { question: null, rankings: event.rankings };
    case "outcome":
      return {
        outcomes: [...picture.outcomes.filter((one) => one.stage !== event.stage), event],
        curves: withCurves(picture, event.stage, event.curves ?? []),
        ...(event.rankings?.length && { rankings: event.rankings }),
      };
    case "ended":
      // nothing waits for a person once the work is over
      return { pressAsked: null, takeAsked: null, question: null };
  }
}

function withCurves(
  { curves }: JobPicture,
  stage: string,
  news: readonly CurveProgress[],
): JobPicture["curves"] {
  return new Map([
    ...curves,
    ...news.map((curve) => [curveKey(stage, curve.stroke, curve.velocity_mm_s), curve] as const),
  ]);
}
