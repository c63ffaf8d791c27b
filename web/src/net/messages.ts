// The studio's messages, made by tools/make_studio_types.py from src/fdvv/studio/_messages_*.py.

export interface Calls {
  readonly "document.change": { readonly ask: DocumentChange; readonly answer: DocumentAnswer };
  readonly "document.copy": { readonly ask: DocumentCopy; readonly answer: DocumentNamed };
  readonly "document.create": { readonly ask: DocumentCreate; readonly answer: DocumentNamed };
  readonly "document.delete": { readonly ask: DocumentDelete; readonly answer: DocumentNamed };
  readonly "document.list": { readonly ask: DocumentListAsk; readonly answer: DocumentRows };
  readonly "document.open": { readonly ask: DocumentAsk; readonly answer: Document };
  readonly "document.rename": { readonly ask: DocumentRename; readonly answer: DocumentNamed };
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
  readonly "studio.about": { readonly ask: AboutAsk; readonly answer: About };
}

export interface Channels {
  readonly "documents": { readonly asks: DocumentsWatch; readonly tells: DocumentsWatching | DocumentChanged | DocumentGone };
  readonly "press": { readonly asks: PressStart | PressLead | PressPush | PressLift | PressReplay | PressHostEvent | PressHere | PressPause | PressStop | PressFail | PressClear; readonly tells: PressReady | PressMeant | PressFrame | PressRefused | PressOver };
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
