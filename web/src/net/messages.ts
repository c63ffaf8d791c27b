// The studio's messages, made by tools/make_studio_types.py from src/fdvv/studio/_messages_*.py.

export interface Calls {
  readonly "jobs.answer": { readonly ask: JobAnswer; readonly answer: JobRow };
  readonly "jobs.cancel": { readonly ask: JobAsk; readonly answer: JobRow };
  readonly "jobs.choices": { readonly ask: NoAsk; readonly answer: WorkChoices };
  readonly "jobs.detail": { readonly ask: JobAsk; readonly answer: JobDetail };
  readonly "jobs.list": { readonly ask: NoAsk; readonly answer: JobRows };
  readonly "jobs.resume": { readonly ask: JobAsk; readonly answer: JobRow };
  readonly "jobs.start": { readonly ask: StartJob; readonly answer: JobRow };
  readonly "studio.about": { readonly ask: AboutAsk; readonly answer: About };
}

export interface Channels {
  readonly "jobs": { readonly asks: WatchJobs | WatchJob; readonly tells: JobsTold | JobChanged | EventsTold };
}

export interface JobAnswer {
  readonly job: string;
  readonly number: number;
  readonly answer: string;
}

export interface JobRow {
  readonly job: string;
  readonly kind: "capture" | "compensate" | "probe" | "tune";
  readonly title: string;
  readonly device: string;
  readonly simulated: boolean;
  readonly state: "cancelled" | "done" | "failed" | "needs you" | "running" | "waiting";
  readonly line: string;
  readonly now: string;
  readonly done: number;
  readonly total: number;
  readonly events: number;
  readonly resumable: boolean;
  readonly created: string;
  readonly ended: string | null;
  readonly results: readonly JobResult[];
}

export interface JobResult {
  readonly kind: "actuation" | "button" | "measured" | "recording" | "rig";
  readonly name: string;
}

export interface JobAsk {
  readonly job: string;
}

export interface NoAsk {
}

export interface WorkChoices {
  readonly buttons: readonly ButtonChoice[];
  readonly devices: readonly DeviceChoice[];
  readonly rigs: readonly string[];
  readonly known_rigs: readonly string[];
  readonly actuations: readonly string[];
  readonly switches: readonly string[];
  readonly participants: readonly string[];
  readonly note: string;
}

export interface ButtonChoice {
  readonly button: string;
  readonly name: string;
  readonly vibrates: boolean;
}

export interface DeviceChoice {
  readonly device: string;
  readonly about: string;
  readonly simulated: boolean;
  readonly rig: boolean;
  readonly bench: boolean;
  readonly used_by: string;
}

export interface JobDetail {
  readonly row: JobRow;
  readonly order: CompensateOrder | ProbeOrder | CaptureOrder | TuneOrder;
}

export interface CompensateOrder {
  readonly type: "compensate";
  readonly button: string;
  readonly name: string;
  readonly device?: string;
  readonly rig?: string;
  readonly seed?: number;
  readonly velocities_mm_s?: readonly number[];
  readonly method?: "paper" | "rig-aware";
  readonly rounds?: number;
  readonly presses?: number;
  readonly known_rig?: string;
  readonly pace_ratio?: number;
  readonly probe_presses?: number;
}

export interface ProbeOrder {
  readonly type: "probe";
  readonly button: string;
  readonly name: string;
  readonly actuation?: string;
  readonly device?: string;
  readonly rig?: string;
  readonly seed?: number;
  readonly velocities_mm_s?: readonly number[];
  readonly presses?: number;
  readonly pace_ratio?: number;
}

export interface CaptureOrder {
  readonly type: "capture";
  readonly name: string;
  readonly device?: string;
  readonly switch?: string;
  readonly participant?: string;
  readonly seed?: number;
  readonly paces_mm_s?: readonly number[];
  readonly presses?: number;
  readonly probe?: boolean;
  readonly shuffled?: boolean;
  readonly repeats?: number;
  readonly pace_ratio?: number;
  readonly watch?: boolean;
}

export interface TuneOrder {
  readonly type: "tune";
  readonly button: string;
  readonly name: string;
  readonly actuation?: string;
  readonly device?: string;
  readonly rig?: string;
  readonly seed?: number;
  readonly velocities_mm_s?: readonly number[];
  readonly observer?: "person" | "simulated observer";
  readonly asking?: "compare" | "rate";
  readonly comparisons?: number;
  readonly repeats?: number;
  readonly frequency_ratios?: readonly number[];
  readonly gain_ratios?: readonly number[];
  readonly pace_ratio?: number;
}

export interface JobRows {
  readonly jobs: readonly JobRow[];
}

export interface StartJob {
  readonly order: CompensateOrder | ProbeOrder | CaptureOrder | TuneOrder;
}

export interface AboutAsk {
}

export interface About {
  readonly version: string;
  readonly project: string;
  readonly sources: readonly string[];
}

export interface WatchJobs {
  readonly type: "watch_jobs";
}

export interface WatchJob {
  readonly type: "watch_job";
  readonly job: string;
  readonly from_event: number;
}

export interface JobsTold {
  readonly type: "jobs";
  readonly jobs: readonly JobRow[];
}

export interface JobChanged {
  readonly type: "job";
  readonly row: JobRow;
}

export interface EventsTold {
  readonly type: "events";
  readonly job: string;
  readonly from_event: number;
  readonly events: readonly (Begun | StageTold | Noticed | Intended | PressAsked | PressTold | TakeAsked | CueBegun | TakeTold | Asked | Answered | Outcome | Ended)[];
}

export interface Begun {
  readonly type: "begun";
  readonly run: number;
  readonly device: string;
  readonly simulated: boolean;
}

export interface StageTold {
  readonly type: "stage";
  readonly stage: "capture" | "compensate" | "probe" | "process" | "tune";
  readonly text: string;
}

export interface Noticed {
  readonly type: "notice";
  readonly text: string;
}

export interface Intended {
  readonly type: "intended";
  readonly velocity_mm_s: number;
  readonly displacement_mm: readonly number[];
  readonly press_cN: readonly number[];
  readonly release_cN: readonly number[];
  readonly noticeable_press_cN: number;
  readonly noticeable_release_cN: number;
}

export interface PressAsked {
  readonly type: "press_asked";
  readonly velocity_mm_s: number;
  readonly travel_mm: number;
  readonly number: number;
  readonly total: number;
}

export interface PressTold {
  readonly type: "press";
  readonly stage: "compensate" | "probe";
  readonly velocity_mm_s: number;
  readonly done: number;
  readonly total: number;
  readonly skipped: string;
  readonly achieved_mm_s: number | null;
  readonly told: string;
  readonly made: number;
  readonly wanted: number | null;
  readonly curves: readonly CurveStanding[];
  readonly felt: FeltCurve | null;
}

export interface CurveStanding {
  readonly stroke: "press" | "release";
  readonly velocity_mm_s: number;
  readonly error_cN: readonly number[];
  readonly mean_error_cN: number | null;
  readonly max_error_cN: number | null;
}

export interface FeltCurve {
  readonly press_cN: readonly (number | null)[];
  readonly release_cN: readonly (number | null)[];
}

export interface TakeAsked {
  readonly type: "take_asked";
  readonly step: "press" | "probe" | "rest";
  readonly velocity_mm_s: number | null;
  readonly travel_mm: number;
  readonly number: number;
  readonly total: number;
  readonly again: string;
  readonly contact_s: number | null;
  readonly bottom_s: number | null;
  readonly length_s: number;
}

export interface CueBegun {
  readonly type: "cue";
}

export interface TakeTold {
  readonly type: "take";
  readonly number: number;
  readonly step: "press" | "probe" | "rest";
  readonly velocity_mm_s: number | null;
  readonly ok: boolean;
  readonly reason: string;
  readonly achieved_mm_s: number | null;
  readonly travel_mm: number | null;
  readonly done: number;
  readonly total: number;
  readonly missed: boolean;
  readonly paces: readonly PaceTold[];
}

export interface PaceTold {
  readonly velocity_mm_s: number;
  readonly good: number;
  readonly wanted: number;
  readonly made: number;
  readonly missed: number;
  readonly achieved_mm_s: readonly number[];
}

export interface Asked {
  readonly type: "asked";
  readonly number: number;
  readonly total: number;
  readonly velocity_mm_s: number;
  readonly waves: readonly Wave[];
  readonly measured: Wave;
}

export interface Wave {
  readonly rate_Hz: number;
  readonly acceleration_m_s2: readonly number[];
}

export interface Answered {
  readonly type: "answered";
  readonly number: number;
  readonly total: number;
  readonly velocity_mm_s: number;
  readonly answer: string;
  readonly rankings: readonly Ranking[];
}

export interface Ranking {
  readonly velocity_mm_s: number;
  readonly answers: number;
  readonly sentence: string;
  readonly candidates: readonly CandidateTold[];
}

export interface CandidateTold {
  readonly name: string;
  readonly frequency_Hz: number;
  readonly amplitude_m_s2: number;
  readonly score: number;
  readonly error: number | null;
  readonly alike: boolean;
  readonly best: boolean;
}

export interface Outcome {
  readonly type: "outcome";
  readonly stage: "capture" | "compensate" | "probe" | "tune";
  readonly sentence: string;
  readonly presses: number;
  readonly skipped: number;
  readonly simulated: boolean;
  readonly curves?: readonly CurveStanding[];
  readonly rankings?: readonly Ranking[];
  readonly warnings?: readonly string[];
}

export interface Ended {
  readonly type: "ended";
  readonly state: "cancelled" | "done" | "failed";
  readonly line: string;
}
