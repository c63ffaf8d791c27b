// The studio's messages, made by tools/make_studio_types.py from src/fdvv/studio/_messages_*.py.

export interface Calls {
  readonly "document.change": { readonly ask: DocumentChange; readonly answer: DocumentAnswer };
  readonly "document.copy": { readonly ask: DocumentCopy; readonly answer: DocumentNamed };
  readonly "document.create": { readonly ask: DocumentCreate; readonly answer: DocumentNamed };
  readonly "document.delete": { readonly ask: DocumentDelete; readonly answer: DocumentNamed };
  readonly "document.list": { readonly ask: DocumentListAsk; readonly answer: DocumentRows };
  readonly "document.open": { readonly ask: DocumentAsk; readonly answer: Document };
  readonly "document.rename": { readonly ask: DocumentRename; readonly answer: DocumentNamed };
  readonly "studio.about": { readonly ask: AboutAsk; readonly answer: About };
}

export interface Channels {
  readonly "documents": { readonly asks: DocumentsWatch; readonly tells: DocumentsWatching | DocumentChanged | DocumentGone };
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
  readonly template: Template | null;
  readonly model: Readonly<Record<string, unknown>> | null;
}

export type Template = "linear" | "tactile";

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
