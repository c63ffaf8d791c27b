// The studio's messages, made by tools/make_studio_types.py from src/fdvv/studio/_messages_*.py.

export interface Calls {
  readonly "device.arm": { readonly ask: DeviceAsk; readonly answer: DeviceStanding };
  readonly "device.clear_fault": { readonly ask: DeviceAsk; readonly answer: DeviceStanding };
  readonly "device.connect": { readonly ask: DeviceConnect; readonly answer: DeviceStanding };
  readonly "device.disconnect": { readonly ask: DeviceAsk; readonly answer: DeviceStanding };
  readonly "device.facts": { readonly ask: DeviceAsk; readonly answer: DeviceFacts };
  readonly "device.press": { readonly ask: DevicePress; readonly answer: DeviceStanding };
  readonly "device.selftest": { readonly ask: DeviceAsk; readonly answer: SelfTest };
  readonly "device.standing": { readonly ask: DeviceAsk; readonly answer: DeviceStanding };
  readonly "device.stop": { readonly ask: DeviceAsk; readonly answer: DeviceStanding };
  readonly "device.upload": { readonly ask: DeviceUpload; readonly answer: DeviceStanding };
  readonly "document.change": { readonly ask: DocumentChange; readonly answer: DocumentAnswer };
  readonly "document.copy": { readonly ask: DocumentCopy; readonly answer: DocumentNamed };
  readonly "document.create": { readonly ask: DocumentCreate; readonly answer: DocumentNamed };
  readonly "document.delete": { readonly ask: DocumentDelete; readonly answer: DocumentNamed };
  readonly "document.list": { readonly ask: DocumentListAsk; readonly answer: DocumentRows };
  readonly "document.open": { readonly ask: DocumentAsk; readonly answer: Document };
  readonly "document.rename": { readonly ask: DocumentRename; readonly answer: DocumentNamed };
  readonly "editor.achievable": { readonly ask: AchievableAsk; readonly answer: Achievable };
  readonly "editor.button": { readonly ask: ButtonAsk; readonly answer: ButtonTold };
  readonly "editor.measured": { readonly ask: MeasuredAsk; readonly answer: Measured };
  readonly "editor.rigs": { readonly ask: RigsAsk; readonly answer: Rigs };
  readonly "jobs.answer": { readonly ask: JobAnswer; readonly answer: JobRow };
  readonly "jobs.cancel": { readonly ask: JobAsk; readonly answer: JobRow };
  readonly "jobs.choices": { readonly ask: JobsAsk; readonly answer: WorkChoices };
  readonly "jobs.detail": { readonly ask: JobAsk; readonly answer: JobDetail };
  readonly "jobs.list": { readonly ask: JobsAsk; readonly answer: JobRows };
  readonly "jobs.resume": { readonly ask: JobAsk; readonly answer: JobRow };
  readonly "jobs.start": { readonly ask: StartJob; readonly answer: JobRow };
  readonly "library.curves": { readonly ask: LibraryCurvesAsk; readonly answer: LibraryCurves };
  readonly "library.find": { readonly ask: LibraryFind; readonly answer: LibraryFound };
  readonly "library.index": { readonly ask: LibraryIndexAsk; readonly answer: LibraryIndex };
  readonly "library.like": { readonly ask: LibraryLikeAsk; readonly answer: LibraryAlikes };
  readonly "library.refused": { readonly ask: LibraryRefusedAsk; readonly answer: LibraryRefused };
  readonly "library.rescan": { readonly ask: LibraryRescanAsk; readonly answer: LibraryStanding };
  readonly "library.search": { readonly ask: LibraryQuery; readonly answer: LibraryRows };
  readonly "optimize.abandon": { readonly ask: OptimizeTrialAsk; readonly answer: OptimizeTrialAsk };
  readonly "optimize.answer": { readonly ask: OptimizeAnswer; readonly answer: OptimizePairAsk };
  readonly "optimize.best": { readonly ask: OptimizeAsk; readonly answer: OptimizeBest };
  readonly "optimize.create": { readonly ask: OptimizeCreate; readonly answer: OptimizeAsk };
  readonly "optimize.detail": { readonly ask: OptimizeAsk; readonly answer: OptimizeDetail };
  readonly "optimize.devices": { readonly ask: OptimizeDevicesAsk; readonly answer: OptimizeDevices };
  readonly "optimize.edit": { readonly ask: OptimizeEdit; readonly answer: OptimizeTrialAsk };
  readonly "optimize.halt": { readonly ask: OptimizeAsk; readonly answer: OptimizeAsk };
  readonly "optimize.list": { readonly ask: OptimizeListAsk; readonly answer: OptimizeRows };
  readonly "optimize.model": { readonly ask: OptimizeModelAsk; readonly answer: OptimizeModel };
  readonly "optimize.next": { readonly ask: OptimizeAsk; readonly answer: OptimizeTrialAsk };
  readonly "optimize.offers": { readonly ask: OptimizeOffersAsk; readonly answer: OptimizeOffers };
  readonly "optimize.pair": { readonly ask: OptimizeAsk; readonly answer: OptimizePairAsk };
  readonly "optimize.simulate": { readonly ask: OptimizeSimulate; readonly answer: OptimizeAsk };
  readonly "press.list": { readonly ask: PressListAsk; readonly answer: PressList };
  readonly "press.trace": { readonly ask: TraceReadAsk; readonly answer: TraceRead };
  readonly "program.check": { readonly ask: CheckProgram; readonly answer: ProgramCheck };
  readonly "program.copy": { readonly ask: CopyProgram; readonly answer: ProgramText };
  readonly "program.delete": { readonly ask: DeleteProgram; readonly answer: ThrownProgram };
  readonly "program.keep": { readonly ask: KeepProgram; readonly answer: ProgramText };
  readonly "program.list": { readonly ask: ProgramsAsk; readonly answer: ProgramRows };
  readonly "program.open": { readonly ask: ProgramAsk; readonly answer: ProgramText };
  readonly "program.ranges": { readonly ask: RangesAsk; readonly answer: ProgramRanges };
  readonly "program.recipe": { readonly ask: MakeProgram; readonly answer: MadeProgram };
  readonly "program.restore": { readonly ask: ThrownProgram; readonly answer: ProgramText };
  readonly "program.save": { readonly ask: SaveProgram; readonly answer: ProgramText };
  readonly "program.surface": { readonly ask: SurfaceAsk; readonly answer: ProgramSurface };
  readonly "studies.create": { readonly ask: StudiesCreate; readonly answer: StudiesAsk };
  readonly "studies.detail": { readonly ask: StudiesAsk; readonly answer: StudiesDetail };
  readonly "studies.devices": { readonly ask: StudiesDevicesAsk; readonly answer: StudiesDevices };
  readonly "studies.freeze": { readonly ask: StudiesFreeze; readonly answer: StudiesDetail };
  readonly "studies.list": { readonly ask: StudiesListAsk; readonly answer: StudiesRows };
  readonly "studies.offers": { readonly ask: StudiesOffersAsk; readonly answer: StudiesOffers };
  readonly "studies.pause": { readonly ask: StudiesPause; readonly answer: StudiesDetail };
  readonly "studies.plan": { readonly ask: StudiesAsk; readonly answer: StudiesPlan };
  readonly "studies.report": { readonly ask: StudiesAsk; readonly answer: StudiesReport };
  readonly "studies.seat": { readonly ask: StudiesAsk; readonly answer: StudiesSeat };
  readonly "studies.unseal": { readonly ask: StudiesUnseal; readonly answer: StudiesUnsealed };
  readonly "studies.use": { readonly ask: StudiesUse; readonly answer: StudiesDetail };
  readonly "studies.verify": { readonly ask: StudiesAsk; readonly answer: StudiesVerified };
  readonly "studies.withdraw": { readonly ask: StudiesWithdraw; readonly answer: StudiesDetail };
  readonly "studies.write": { readonly ask: StudiesWrite; readonly answer: StudiesPlan };
  readonly "studio.about": { readonly ask: AboutAsk; readonly answer: About };
}

export interface Channels {
  readonly "documents": { readonly asks: DocumentsWatch; readonly tells: DocumentsWatching | DocumentChanged | DocumentGone };
  readonly "jobs": { readonly asks: WatchJobs | WatchJob; readonly tells: JobsTold | JobChanged | EventsTold };
  readonly "library": { readonly asks: LibraryWatch; readonly tells: LibraryStanding };
  readonly "optimize": { readonly asks: OptimizeWatch; readonly tells: OptimizeWatching | OptimizeChanged };
  readonly "play": { readonly asks: PlayOpen | PlayPing | PlayDown | PlayUp | PlayRound | PlayClose; readonly tells: PlayReady | PlayPong | PlayClick | PlayKept | PlayOver };
  readonly "press": { readonly asks: PressStart | PressLead | PressPush | PressLift | PressReplay | PressHostEvent | PressHere | PressPause | PressStop | PressFail | PressClear; readonly tells: PressReady | PressMeant | PressFrame | PressRefused | PressOver };
  readonly "scope": { readonly asks: WatchScope; readonly tells: DeviceStanding | ScopeTold | PressSeen };
  readonly "studies": { readonly asks: StudiesWatch; readonly tells: StudiesWatching | StudiesChanged };
  readonly "study": { readonly asks: StudyLook | StudySit | StudyResume | StudyShown | StudyGo | StudyLead | StudyPush | StudyLift | StudyAgain | StudyAnswered | StudyFilled | StudyRested | StudyWithdraw | StudyHere; readonly tells: StudyAbout | StudyCard | StudyStep | StudyReady | StudyFelt | StudyFrame | StudyBroke | StudyPaused | StudyStopped };
}

export interface DeviceAsk {
}

export interface DeviceStanding {
  readonly type: "standing";
  readonly device?: string;
  readonly name?: string;
  readonly simulated?: boolean;
  readonly streams?: boolean;
  readonly person?: boolean;
  readonly force_sensor?: boolean;
  readonly tick_s?: number;
  readonly mode?: string;
  readonly programmed?: string;
  readonly travel_mm?: number | null;
  readonly fault?: string;
  readonly missing_ticks?: number;
  readonly late_ticks?: number;
  readonly missing_frames?: number;
  readonly lost_records?: number;
}

export interface DeviceConnect {
  readonly device: string;
  readonly rig?: string;
  readonly seed?: number;
}

export interface DeviceFacts {
  readonly facts: readonly DeviceFact[];
}

export interface DeviceFact {
  readonly name: string;
  readonly value: string;
}

export interface DevicePress {
  readonly velocity_mm_s: number;
}

export interface SelfTest {
  readonly parts: readonly PartVerdict[];
  readonly note: string;
}

export interface PartVerdict {
  readonly part: string;
  readonly verdict: string;
  readonly value: number;
}

export interface DeviceUpload {
  readonly button: string;
  readonly actuation?: string;
  readonly velocities_mm_s?: readonly number[];
}

export interface DocumentChange {
  readonly button: string;
  readonly revision: number;
  readonly change: EditMade | UndoMade | RedoMade | PinMade | UnpinMade;
}

export interface EditMade {
  readonly type: "edit";
  readonly change_id: string;
  readonly label: string;
  readonly patch: Patch;
  readonly joins: boolean;
  readonly time_s: number;
}

export interface Patch {
  readonly fields?: Readonly<Record<string, readonly [unknown, unknown]>>;
  readonly curves?: readonly CurveChange[];
  readonly vibrations?: readonly VibrationChange[];
}

export interface CurveChange {
  readonly stroke: Stroke;
  readonly velocity_mm_s: number | null;
  readonly before?: Readonly<Record<string, unknown>> | null;
  readonly after?: Readonly<Record<string, unknown>> | null;
  readonly points?: readonly (readonly [number, number, number])[] | null;
}

export type Stroke = "press" | "release";

export interface VibrationChange {
  readonly stroke: Stroke;
  readonly velocity_mm_s: number | null;
  readonly before?: Readonly<Record<string, unknown>> | null;
  readonly after?: Readonly<Record<string, unknown>> | null;
}

export interface UndoMade {
  readonly type: "undo";
  readonly change_id: string;
  readonly count: number;
}

export interface RedoMade {
  readonly type: "redo";
  readonly change_id: string;
  readonly count: number;
}

export interface PinMade {
  readonly type: "pin";
  readonly change_id: string;
  readonly label: string;
}

export interface UnpinMade {
  readonly type: "unpin";
  readonly change_id: string;
  readonly index: number;
}

export interface DocumentAnswer {
  readonly revision: number;
  readonly conflict: Document | null;
}

export interface Document {
  readonly button: string;
  readonly editable: boolean;
  readonly revision: number;
  readonly opening: Readonly<Record<string, unknown>>;
  readonly steps: readonly DraftStep[];
  readonly done: number;
  readonly pins: readonly DraftPin[];
}

export interface DraftStep {
  readonly label: string;
  readonly patches: readonly Patch[];
  readonly time_s: number;
}

export interface DraftPin {
  readonly label: string;
  readonly model: Readonly<Record<string, unknown>>;
}

export interface DocumentCopy {
  readonly button: string;
  readonly name: string | null;
}

export interface DocumentNamed {
  readonly button: string;
}

export interface DocumentCreate {
  readonly name: string | null;
  readonly template: ModelTemplate | null;
  readonly model: Readonly<Record<string, unknown>> | null;
}

export type ModelTemplate = "linear" | "tactile";

export interface DocumentDelete {
  readonly button: string;
}

export interface DocumentListAsk {
}

export interface DocumentRows {
  readonly rows: readonly DocumentRow[];
}

export interface DocumentRow {
  readonly button: string;
  readonly name: string;
  readonly changed_s: number;
  readonly size_bytes: number;
}

export interface DocumentAsk {
  readonly button: string;
}

export interface DocumentRename {
  readonly button: string;
  readonly name: string;
}

export interface AchievableAsk {
  readonly model: unknown;
  readonly velocities_mm_s: readonly (number | null)[];
  readonly rig_id: string;
}

export interface Achievable {
  readonly curves: readonly AchievableForce[];
}

export interface AchievableForce {
  readonly stroke: "press" | "release";
  readonly velocity_mm_s: number;
  readonly displacement_mm: readonly number[];
  readonly intended_cN: readonly number[];
  readonly achievable_cN: readonly number[];
  readonly limited: readonly LimitedPart[];
  readonly verdict: string;
  readonly reasons: readonly string[];
  readonly expected_mean_cN: number;
}

export interface LimitedPart {
  readonly start_mm: number;
  readonly end_mm: number;
  readonly limit: "force" | "slew";
}

export interface ButtonAsk {
  readonly button_id: string;
}

export interface ButtonTold {
  readonly model: unknown;
}

export interface MeasuredAsk {
  readonly name: string;
}

export interface Measured {
  readonly found: MeasuredPresses | null;
}

export interface MeasuredPresses {
  readonly device_name: string;
  readonly presses: number;
  readonly simulated: boolean;
  readonly curves: readonly MeasuredForce[];
}

export interface MeasuredForce {
  readonly stroke: "press" | "release";
  readonly velocity_mm_s: number;
  readonly displacement_mm: readonly number[];
  readonly low_cN: readonly number[];
  readonly median_cN: readonly number[];
  readonly high_cN: readonly number[];
  readonly mean_error_cN: number;
}

export interface RigsAsk {
}

export interface Rigs {
  readonly rigs: readonly RigChoice[];
}

export interface RigChoice {
  readonly rig_id: string;
  readonly about: string;
  readonly simulated: boolean;
  readonly known: boolean;
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

export interface JobsAsk {
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

export interface LibraryCurvesAsk {
  readonly ids: readonly string[];
}

export interface LibraryCurves {
  readonly buttons: readonly LibraryButton[];
  readonly missing: readonly LibraryMissing[];
}

export interface LibraryButton {
  readonly id: string;
  readonly name: string;
  readonly origin: Origin;
  readonly kind: ButtonType;
  readonly kind_reason: string;
  readonly collection: string;
  readonly stated: readonly string[];
  readonly numbers: Readonly<Record<string, number | null>>;
  readonly why: readonly string[];
  readonly cycles: number | null;
  readonly used: number | null;
  readonly date: string | null;
  readonly source: string;
  readonly licence: string;
  readonly simulated: boolean;
  readonly strokes: readonly LibraryStroke[];
}

export type Origin = "builtin" | "own" | "measured";

export type ButtonType = "linear" | "tactile" | "clicky?" | "dome?" | "unclear";

export interface LibraryStroke {
  readonly stroke: string;
  readonly velocity_mm_s: number | null;
  readonly start_mm: number;
  readonly step_mm: number;
  readonly force_cN: readonly number[];
}

export interface LibraryMissing {
  readonly id: string;
  readonly reason: string;
}

export interface LibraryFind {
  readonly text?: string;
  readonly kinds?: readonly ButtonType[];
  readonly origins?: readonly Origin[];
  readonly ranges?: Readonly<Record<string, LibraryRange>>;
  readonly like?: string | null;
  readonly sort?: string;
  readonly descending?: boolean;
}

export interface LibraryRange {
  readonly low?: number | null;
  readonly high?: number | null;
}

export interface LibraryFound {
  readonly epoch: number;
  readonly positions: readonly number[];
  readonly distances_jnd: readonly number[];
  readonly histograms: Readonly<Record<string, LibraryHistogram>>;
  readonly kinds: Readonly<Record<string, number>>;
  readonly origins: Readonly<Record<string, number>>;
  readonly without: Readonly<Record<string, number>>;
  readonly mended: readonly string[];
}

export interface LibraryHistogram {
  readonly lowest: number;
  readonly highest: number;
  readonly counts: readonly number[];
}

export interface LibraryIndexAsk {
  readonly epoch?: number;
  readonly first?: number;
}

export interface LibraryIndex {
  readonly standing: LibraryStanding;
  readonly first: number;
  readonly ids: readonly string[];
  readonly names: readonly string[];
  readonly collections: readonly string[];
  readonly origins: readonly Origin[];
  readonly kinds: readonly ButtonType[];
  readonly stated: readonly (readonly string[])[];
  readonly speeds_mm_s: readonly (readonly number[])[];
  readonly dates: readonly (string | null)[];
  readonly simulated: readonly boolean[];
  readonly numbers: Readonly<Record<string, readonly (number | null)[]>>;
  readonly sketches: string;
}

export interface LibraryStanding {
  readonly type: "standing";
  readonly epoch: number;
  readonly rows: number;
  readonly refused: number;
  readonly done: number;
  readonly total: number;
  readonly ended: boolean;
  readonly sources: number;
  readonly trouble: string;
}

export interface LibraryLikeAsk {
  readonly id: string;
  readonly limit?: number;
}

export interface LibraryAlikes {
  readonly alike: readonly LibraryAlike[];
}

export interface LibraryAlike {
  readonly row: LibraryRow;
  readonly distance_jnd: number;
  readonly force_jnd: number;
  readonly shape_jnd: number;
  readonly landmarks_jnd: number;
}

export interface LibraryRow {
  readonly id: string;
  readonly name: string;
  readonly origin: Origin;
  readonly kind: ButtonType;
  readonly collection: string;
  readonly stated: readonly string[];
  readonly peak_cN: number | null;
  readonly drop_cN: number | null;
  readonly actuation_mm: number | null;
  readonly bottom_out_cN: number | null;
  readonly travel_mm: number;
  readonly simulated: boolean;
}

export interface LibraryRefusedAsk {
}

export interface LibraryRefused {
  readonly files: readonly LibraryRefusal[];
}

export interface LibraryRefusal {
  readonly place: string;
  readonly reason: string;
}

export interface LibraryRescanAsk {
}

export interface LibraryQuery {
  readonly text?: string;
  readonly kinds?: readonly ButtonType[];
  readonly origins?: readonly Origin[];
  readonly limit?: number;
}

export interface LibraryRows {
  readonly rows: readonly LibraryRow[];
  readonly total: number;
  readonly ended: boolean;
}

export interface OptimizeTrialAsk {
  readonly run: number;
  readonly trial: number;
}

export interface OptimizeAnswer {
  readonly run: number;
  readonly pair: number;
  readonly answer: Answer;
}

export type Answer = "first" | "second" | "equal";

export interface OptimizePairAsk {
  readonly run: number;
  readonly pair: number;
}

export interface OptimizeAsk {
  readonly run: number;
}

export interface OptimizeBest {
  readonly design: Readonly<Record<string, number>> | null;
}

export interface OptimizeCreate {
  readonly title: string;
  readonly engine: string;
  readonly space: string;
  readonly preference: boolean;
  readonly simulated: boolean;
  readonly level: "easy" | "hard";
  readonly also: readonly string[];
  readonly start: string | null;
  readonly rig: string | null;
  readonly seed: number;
  readonly budget: number;
  readonly task_presses?: number;
  readonly others?: string | null;
}

export interface OptimizeDetail {
  readonly row: OptimizeRow;
  readonly seed: number;
  readonly parameters: readonly OptimizeParameter[];
  readonly rules: readonly string[];
  readonly objectives: readonly OptimizeObjective[];
  readonly rounds: number;
  readonly strip: OptimizeStrip;
  readonly trials: readonly OptimizeTrial[];
  readonly pairs: readonly OptimizePair[];
  readonly start: Readonly<Record<string, number>> | null;
  readonly start_name: string;
  readonly others: string;
  readonly simulated: OptimizeSimulated | null;
  readonly playable: boolean;
}

export interface OptimizeRow {
  readonly run: number;
  readonly title: string;
  readonly engine: string;
  readonly preference: boolean;
  readonly simulated: boolean;
  readonly level: string;
  readonly spent: number;
  readonly budget: number;
  readonly best: OptimizeScore | null;
  readonly made: string;
  readonly problem: string;
}

export interface OptimizeScore {
  readonly value: number;
  readonly error: number | null;
}

export interface OptimizeParameter {
  readonly name: string;
  readonly low: number;
  readonly high: number;
}

export interface OptimizeObjective {
  readonly name: string;
  readonly larger_is_better: boolean;
}

export interface OptimizeStrip {
  readonly pixels: number;
  readonly zone_px: number;
  readonly zone_half_px: number;
  readonly speed_px_s: number;
}

export interface OptimizeTrial {
  readonly number: number;
  readonly design: Readonly<Record<string, number>>;
  readonly edited: boolean;
  readonly state: TrialState;
  readonly scores: Readonly<Record<string, OptimizeScore>>;
  readonly reason: string;
  readonly origin: string;
  readonly curve: OptimizeCurve;
  readonly front: boolean;
}

export type TrialState = "suggested" | "shown" | "done" | "failed" | "abandoned";

export interface OptimizeCurve {
  readonly step_mm: number;
  readonly force_cN: readonly number[];
  readonly actuation_mm: number | null;
}

export interface OptimizePair {
  readonly number: number;
  readonly first: Readonly<Record<string, number>>;
  readonly second: Readonly<Record<string, number>>;
  readonly first_curve: OptimizeCurve;
  readonly second_curve: OptimizeCurve;
  readonly answer: Answer | null;
}

export interface OptimizeSimulated {
  readonly running: boolean;
  readonly done: number;
  readonly total: number;
  readonly told: string;
  readonly fault: string;
}

export interface OptimizeDevicesAsk {
}

export interface OptimizeDevices {
  readonly devices: readonly OptimizeOffer[];
}

export interface OptimizeOffer {
  readonly name: string;
  readonly told: string;
}

export interface OptimizeEdit {
  readonly run: number;
  readonly trial: number;
  readonly design: Readonly<Record<string, number>>;
}

export interface OptimizeListAsk {
}

export interface OptimizeRows {
  readonly rows: readonly OptimizeRow[];
}

export interface OptimizeModelAsk {
  readonly run: number;
  readonly design: Readonly<Record<string, number>>;
  readonly name: string;
}

export interface OptimizeModel {
  readonly model: Readonly<Record<string, unknown>>;
}

export interface OptimizeOffersAsk {
}

export interface OptimizeOffers {
  readonly engines: readonly OptimizeOffer[];
  readonly pair_engines: readonly OptimizeOffer[];
  readonly spaces: readonly OptimizeOffer[];
  readonly rigs: readonly OptimizeOffer[];
  readonly levels: readonly OptimizeOffer[];
  readonly objectives: readonly OptimizeOffer[];
  readonly starts: readonly OptimizeOffer[];
  readonly others: readonly OptimizeOffer[];
}

export interface OptimizeSimulate {
  readonly run: number;
  readonly person: number;
  readonly trials: number;
}

export interface PressListAsk {
}

export interface PressList {
  readonly buttons: readonly PressItem[];
  readonly programs: readonly PressItem[];
  readonly traces: readonly TraceItem[];
  readonly rigs: readonly string[];
}

export interface PressItem {
  readonly id: string;
  readonly name: string;
  readonly hint: string;
}

export interface TraceItem {
  readonly name: string;
  readonly told: string;
  readonly duration_s: number;
  readonly t_s: readonly number[];
  readonly displacement_mm: readonly number[];
}

export interface TraceReadAsk {
  readonly name: string;
  readonly text: string;
}

export interface TraceRead {
  readonly name: string;
  readonly told: string;
  readonly t_s: readonly number[];
  readonly displacement_mm: readonly number[];
}

export interface CheckProgram {
  readonly text: string;
}

export interface ProgramCheck {
  readonly accepted: boolean;
  readonly findings: readonly ProgramFinding[];
  readonly sizes: readonly ProgramSize[];
  readonly surfaces: readonly ProgramSurfaceSize[];
  readonly return_s: number | null;
  readonly stiffness_cN_mm: number | null;
  readonly rise_K: number | null;
}

export interface ProgramFinding {
  readonly severity: "refused" | "warning";
  readonly path: string;
  readonly state: string;
  readonly place: string;
  readonly reason: string;
  readonly remedy: string;
  readonly at_mm: number | null;
}

export interface ProgramSize {
  readonly what: string;
  readonly taken: number | null;
  readonly most: number;
}

export interface ProgramSurfaceSize {
  readonly name: string;
  readonly columns: number;
  readonly rows: number;
  readonly error_cN: number;
}

export interface CopyProgram {
  readonly program: string;
  readonly name?: string;
}

export interface ProgramText {
  readonly program: string;
  readonly text: string;
  readonly revision: string;
}

export interface DeleteProgram {
  readonly program: string;
  readonly revision: string;
}

export interface ThrownProgram {
  readonly thrown: string;
}

export interface KeepProgram {
  readonly text: string;
}

export interface ProgramsAsk {
}

export interface ProgramRows {
  readonly programs: readonly ProgramRow[];
  readonly recipes: readonly ProgramRecipe[];
  readonly bases: readonly string[];
}

export interface ProgramRow {
  readonly id: string;
  readonly name: string;
  readonly summary: string;
  readonly states: number;
  readonly transitions: number;
  readonly problem: string;
}

export interface ProgramRecipe {
  readonly name: string;
  readonly summary: string;
  readonly details: string;
  readonly parameters: readonly ProgramParameter[];
}

export interface ProgramParameter {
  readonly name: string;
  readonly default: number;
  readonly whole: boolean;
  readonly low: number;
  readonly high: number;
}

export interface ProgramAsk {
  readonly program: string;
}

export interface RangesAsk {
  readonly recipe: string;
  readonly base: string;
  readonly levels?: number;
}

export interface ProgramRanges {
  readonly parameters: readonly ProgramParameter[];
}

export interface MakeProgram {
  readonly recipe: string;
  readonly base: string;
  readonly parameters: Readonly<Record<string, number>>;
}

export interface MadeProgram {
  readonly text: string;
}

export interface SaveProgram {
  readonly program: string;
  readonly text: string;
  readonly revision?: string;
}

export interface SurfaceAsk {
  readonly button: string;
  readonly stroke: "press" | "release";
}

export interface ProgramSurface {
  readonly displacement_mm: readonly number[];
  readonly velocity_mm_s: readonly number[];
  readonly force_cN: readonly (readonly number[])[];
}

export interface StudiesCreate {
  readonly name: string;
  readonly template: string;
}

export interface StudiesAsk {
  readonly study: string;
}

export interface StudiesDetail {
  readonly row: StudiesRow;
  readonly fingerprint: string;
  readonly frozen: string;
  readonly people: readonly StudiesPerson[];
  readonly waiting: number;
  readonly paused: boolean;
  readonly history: readonly string[];
  readonly device: string;
}

export interface StudiesRow {
  readonly name: string;
  readonly title: string;
  readonly kind: string;
  readonly state: "broken" | "draft" | "frozen" | "unsealed";
  readonly people: number;
  readonly planned: number;
  readonly problem: string;
}

export interface StudiesPerson {
  readonly person: string;
  readonly language: string;
  readonly state: string;
  readonly answered: number;
  readonly trials: number;
  readonly here: boolean;
  readonly paused: boolean;
  readonly told: string;
}

export interface StudiesDevicesAsk {
}

export interface StudiesDevices {
  readonly devices: readonly StudiesDevice[];
}

export interface StudiesDevice {
  readonly name: string;
  readonly about: string;
}

export interface StudiesFreeze {
  readonly study: string;
  readonly passphrase: string;
}

export interface StudiesListAsk {
}

export interface StudiesRows {
  readonly rows: readonly StudiesRow[];
}

export interface StudiesOffersAsk {
}

export interface StudiesOffers {
  readonly templates: readonly StudiesOffer[];
}

export interface StudiesOffer {
  readonly name: string;
  readonly told: string;
}

export interface StudiesPause {
  readonly study: string;
  readonly person: string | null;
  readonly on: boolean;
}

export interface StudiesPlan {
  readonly study: string;
  readonly text: string;
  readonly problems: readonly string[];
  readonly preview: readonly StudiesSection[];
}

export interface StudiesSection {
  readonly title: string;
  readonly paragraphs: readonly string[];
  readonly tables: readonly StudiesTable[];
}

export interface StudiesTable {
  readonly heads: readonly string[];
  readonly rows: readonly (readonly string[])[];
}

export interface StudiesReport {
  readonly name: string;
  readonly html: string;
}

export interface StudiesSeat {
  readonly study: string;
  readonly seat: string;
}

export interface StudiesUnseal {
  readonly study: string;
  readonly passphrase: string;
  readonly who: string;
  readonly why: string;
}

export interface StudiesUnsealed {
  readonly rows: number;
  readonly excluded: number;
  readonly folder: string;
}

export interface StudiesUse {
  readonly study: string;
  readonly device: string;
}

export interface StudiesVerified {
  readonly problems: readonly string[];
}

export interface StudiesWithdraw {
  readonly study: string;
  readonly person: string;
  readonly delete: boolean;
}

export interface StudiesWrite {
  readonly study: string;
  readonly text: string;
  readonly keep: boolean;
}

export interface AboutAsk {
}

export interface About {
  readonly version: string;
  readonly project: string;
  readonly sources: readonly string[];
}

export interface DocumentsWatch {
  readonly type: "watch";
}

export interface DocumentsWatching {
  readonly type: "watching";
}

export interface DocumentChanged {
  readonly type: "changed";
  readonly button: string;
  readonly revision: number;
}

export interface DocumentGone {
  readonly type: "gone";
  readonly button: string;
  readonly renamed_to: string | null;
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
  readonly events: readonly (JobBegun | StageTold | JobNoticed | CurveIntended | PressAsked | PressTold | TakeAsked | CueBegun | TakeTold | QuestionAsked | QuestionAnswered | JobOutcome | JobEnded)[];
}

export interface JobBegun {
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

export interface JobNoticed {
  readonly type: "notice";
  readonly text: string;
}

export interface CurveIntended {
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

export interface QuestionAsked {
  readonly type: "asked";
  readonly number: number;
  readonly total: number;
  readonly velocity_mm_s: number;
  readonly waves: readonly PlayedWave[];
  readonly measured: PlayedWave;
}

export interface PlayedWave {
  readonly rate_Hz: number;
  readonly acceleration_m_s2: readonly number[];
}

export interface QuestionAnswered {
  readonly type: "answered";
  readonly number: number;
  readonly total: number;
  readonly velocity_mm_s: number;
  readonly answer: string;
  readonly rankings: readonly TuneRanking[];
}

export interface TuneRanking {
  readonly velocity_mm_s: number;
  readonly answers: number;
  readonly sentence: string;
  readonly candidates: readonly TuneCandidate[];
}

export interface TuneCandidate {
  readonly name: string;
  readonly frequency_Hz: number;
  readonly amplitude_m_s2: number;
  readonly score: number;
  readonly error: number | null;
  readonly alike: boolean;
  readonly best: boolean;
}

export interface JobOutcome {
  readonly type: "outcome";
  readonly stage: "capture" | "compensate" | "probe" | "tune";
  readonly sentence: string;
  readonly presses: number;
  readonly skipped: number;
  readonly simulated: boolean;
  readonly curves?: readonly CurveStanding[];
  readonly rankings?: readonly TuneRanking[];
  readonly warnings?: readonly string[];
}

export interface JobEnded {
  readonly type: "ended";
  readonly state: "cancelled" | "done" | "failed";
  readonly line: string;
}

export interface LibraryWatch {
  readonly type: "watch";
}

export interface OptimizeWatch {
  readonly type: "watch";
}

export interface OptimizeWatching {
  readonly type: "watching";
}

export interface OptimizeChanged {
  readonly type: "changed";
  readonly run: number;
}

export interface PlayOpen {
  readonly type: "open";
  readonly run: number;
  readonly trial: number;
  readonly device?: string;
}

export interface PlayPing {
  readonly type: "ping";
  readonly sent_ms: number;
}

export interface PlayDown {
  readonly type: "down";
  readonly at_ms: number;
}

export interface PlayUp {
  readonly type: "up";
  readonly at_ms: number;
}

export interface PlayRound {
  readonly type: "round";
  readonly number: number;
  readonly start_ms: number;
  readonly target_ms: number;
  readonly end_ms: number;
  readonly hand: "button" | "key" | "mouse" | "pen" | "touch";
  readonly display: PlayDelay;
  readonly input: PlayDelay;
  readonly clock_ms: number | null;
  readonly clock_error_ms: number | null;
  readonly frame_ms: number;
}

export interface PlayDelay {
  readonly ms: number;
  readonly error_ms: number;
}

export interface PlayClose {
  readonly type: "close";
}

export interface PlayReady {
  readonly type: "ready";
  readonly run: number;
  readonly trial: number;
  readonly attempt: number;
  readonly rounds: number;
  readonly told: string;
  readonly signals: readonly ShakeSignal[];
}

export interface ShakeSignal {
  readonly name: string;
  readonly duration_s: number;
  readonly modes: readonly ShakeMode[];
}

export interface ShakeMode {
  readonly frequency_Hz: number;
  readonly amplitude_m_s2: number;
  readonly decay_1_s: number;
  readonly phase_rad: number;
}

export interface PlayPong {
  readonly type: "pong";
  readonly sent_ms: number;
  readonly server_ms: number;
}

export interface PlayClick {
  readonly type: "click";
  readonly slot: number;
  readonly server_ms: number;
  readonly velocity_mm_s: number;
}

export interface PlayKept {
  readonly type: "kept";
  readonly number: number;
  readonly late_ms: number | null;
  readonly transport_ms: number | null;
  readonly finished: boolean;
}

export interface PlayOver {
  readonly type: "over";
  readonly reason: string;
}

export interface PressStart {
  readonly type: "start";
  readonly button?: string | null;
  readonly program?: string | null;
  readonly model?: Readonly<Record<string, unknown>> | null;
  readonly code?: Readonly<Record<string, unknown>> | null;
  readonly mode?: PressMode;
  readonly rig?: string;
  readonly seed?: number;
}

export type PressMode = "intended" | "compensated" | "rendered";

export interface PressLead {
  readonly type: "lead";
  readonly referent_mm: number;
  readonly velocity_mm_s: number;
  readonly sequence: number;
  readonly near_1_s?: number;
}

export interface PressPush {
  readonly type: "push";
  readonly force_cN: number;
  readonly sequence: number;
}

export interface PressLift {
  readonly type: "lift";
  readonly sequence: number;
}

export interface PressReplay {
  readonly type: "replay";
  readonly name: string;
  readonly t_s?: readonly number[] | null;
  readonly displacement_mm?: readonly number[] | null;
}

export interface PressHostEvent {
  readonly type: "event";
  readonly number: number;
}

export interface PressHere {
  readonly type: "here";
}

export interface PressPause {
  readonly type: "pause";
}

export interface PressStop {
  readonly type: "stop";
}

export interface PressFail {
  readonly type: "fail";
}

export interface PressClear {
  readonly type: "clear";
}

export interface PressReady {
  readonly type: "ready";
  readonly name: string;
  readonly told: string;
  readonly mode: PressMode;
  readonly rig: string;
  readonly travel_mm: number;
  readonly actuation_mm: number | null;
  readonly reset_mm: number | null;
  readonly places: readonly PressPlace[];
  readonly states: readonly string[];
  readonly signals: readonly ShakeSignal[];
  readonly meant: PressMeant;
}

export interface PressPlace {
  readonly label: string;
  readonly place_mm: number;
}

export interface PressMeant {
  readonly type: "meant";
  readonly velocity_mm_s: number;
  readonly displacement_mm: readonly number[];
  readonly press_cN: readonly number[];
  readonly release_cN: readonly number[];
}

export interface PressFrame {
  readonly type: "frame";
  readonly t_s: readonly number[];
  readonly displacement_mm: readonly number[];
  readonly force_cN: readonly number[];
  readonly finger_mm: readonly number[];
  readonly velocity_mm_s: number;
  readonly commanded_cN: number;
  readonly state: number;
  readonly key: number;
  readonly mode: number;
  readonly saturated: boolean;
  readonly warm_K: number;
  readonly events: readonly PressHappened[];
  readonly sequence: number;
  readonly dropped_s: number;
  readonly busy_ratio: number;
  readonly replaying: boolean;
}

export interface PressHappened {
  readonly kind: LiveEventKind;
  readonly t_s: number;
  readonly displacement_mm: number;
  readonly velocity_mm_s: number;
  readonly number: number;
  readonly told: string;
}

export type LiveEventKind = "actuation" | "reset" | "level" | "vibration" | "pressed" | "fault";

export interface PressRefused {
  readonly type: "refused";
  readonly reason: string;
}

export interface PressOver {
  readonly type: "over";
  readonly reason: string;
}

export interface WatchScope {
  readonly type: "watch_scope";
  readonly bin_s: number;
}

export interface ScopeTold {
  readonly type: "scope";
  readonly bin_s: number;
  readonly bin: readonly number[];
  readonly displacement_low_mm: readonly number[];
  readonly displacement_high_mm: readonly number[];
  readonly force_low_cN: readonly (number | null)[];
  readonly force_high_cN: readonly (number | null)[];
  readonly commanded_low_cN: readonly number[];
  readonly commanded_high_cN: readonly number[];
  readonly state: readonly number[];
  readonly cut: readonly boolean[];
  readonly ticks: readonly number[];
}

export interface PressSeen {
  readonly type: "press_seen";
  readonly velocity_mm_s: number;
  readonly simulated: boolean;
  readonly displacement_mm: readonly number[];
  readonly felt_press_cN: readonly (number | null)[];
  readonly felt_release_cN: readonly (number | null)[];
  readonly intended_press_cN: readonly number[];
  readonly intended_release_cN: readonly number[];
}

export interface StudiesWatch {
  readonly type: "watch";
}

export interface StudiesWatching {
  readonly type: "watching";
}

export interface StudiesChanged {
  readonly type: "changed";
  readonly study: string;
}

export interface StudyLook {
  readonly type: "look";
  readonly study: string;
  readonly seat: string;
  readonly holder: string;
}

export interface StudySit {
  readonly type: "sit";
  readonly study: string;
  readonly seat: string;
  readonly holder: string;
  readonly language: string;
}

export interface StudyResume {
  readonly type: "resume";
  readonly study: string;
  readonly person: string;
  readonly code: string;
}

export interface StudyShown {
  readonly type: "shown";
  readonly number: number;
}

export interface StudyGo {
  readonly type: "go";
  readonly label: string;
}

export interface StudyLead {
  readonly type: "lead";
  readonly referent_mm: number;
  readonly velocity_mm_s: number;
  readonly near_1_s?: number;
}

export interface StudyPush {
  readonly type: "push";
  readonly force_cN: number;
}

export interface StudyLift {
  readonly type: "lift";
}

export interface StudyAgain {
  readonly type: "again";
}

export interface StudyAnswered {
  readonly type: "answer";
  readonly number: number;
  readonly choice: string;
  readonly ratings: Readonly<Record<string, Readonly<Record<string, number>>>>;
}

export interface StudyFilled {
  readonly type: "page";
  readonly name: string;
  readonly values: Readonly<Record<string, string | number>>;
  readonly agreed: boolean;
}

export interface StudyRested {
  readonly type: "rested";
}

export interface StudyWithdraw {
  readonly type: "withdraw";
}

export interface StudyHere {
  readonly type: "here";
}

export interface StudyAbout {
  readonly type: "about";
  readonly study: string;
  readonly titles: Readonly<Record<string, string>>;
  readonly languages: readonly string[];
  readonly seat: boolean;
}

export interface StudyCard {
  readonly type: "card";
  readonly person: string;
  readonly language: string;
  readonly code: string;
}

export interface StudyStep {
  readonly type: "step";
  readonly kind: "break" | "declined" | "done" | "page" | "practice" | "trial" | "withdrawn";
  readonly progress_ratio: number;
  readonly form?: StudyForm | null;
  readonly task?: StudyTask | null;
  readonly left_s?: number | null;
}

export interface StudyForm {
  readonly name: string;
  readonly title: string;
  readonly paragraphs: readonly string[];
  readonly questions: readonly StudyAsked[];
  readonly consent: boolean;
}

export interface StudyAsked {
  readonly name: string;
  readonly question: string;
  readonly choices: readonly string[];
  readonly low: number | null;
  readonly high: number | null;
  readonly required: boolean;
}

export interface StudyTask {
  readonly number: number;
  readonly at: number;
  readonly of: number;
  readonly item: string;
  readonly question: string;
  readonly places: readonly string[];
  readonly choices: readonly string[];
  readonly equal: string;
  readonly rated: readonly string[];
  readonly scales: readonly StudyScale[];
}

export interface StudyScale {
  readonly name: string;
  readonly question: string;
  readonly low: string;
  readonly high: string;
  readonly points: number;
}

export interface StudyReady {
  readonly type: "ready";
  readonly number: number;
  readonly travel_mm: number;
  readonly signals: readonly ShakeSignal[];
}

export interface StudyFelt {
  readonly type: "felt";
  readonly label: string;
}

export interface StudyFrame {
  readonly type: "frame";
  readonly label: string;
  readonly t_s: number;
  readonly displacement_mm: number;
  readonly key: boolean;
  readonly pressed: number;
  readonly dropped_s: number;
  readonly clicks: readonly StudyClick[];
}

export interface StudyClick {
  readonly sound: number;
  readonly t_s: number;
  readonly velocity_mm_s: number;
}

export interface StudyBroke {
  readonly type: "broke";
}

export interface StudyPaused {
  readonly type: "paused";
  readonly on: boolean;
}

export interface StudyStopped {
  readonly type: "stopped";
  readonly reason: string;
}
