// The studio's messages, made by tools/make_studio_types.py from src/fdvv/studio/_messages_*.py.

export interface Calls {
  readonly "library.curves": { readonly ask: LibraryCurvesAsk; readonly answer: LibraryCurves };
  readonly "library.find": { readonly ask: LibraryFind; readonly answer: LibraryFound };
  readonly "library.index": { readonly ask: LibraryIndexAsk; readonly answer: LibraryIndex };
  readonly "library.like": { readonly ask: LibraryLikeAsk; readonly answer: LibraryAlikes };
  readonly "library.refused": { readonly ask: LibraryRefusedAsk; readonly answer: LibraryRefused };
  readonly "library.rescan": { readonly ask: LibraryRescanAsk; readonly answer: LibraryStanding };
  readonly "library.search": { readonly ask: LibraryQuery; readonly answer: LibraryRows };
  readonly "studio.about": { readonly ask: AboutAsk; readonly answer: About };
}

export interface Channels {
  readonly "library": { readonly asks: LibraryWatch; readonly tells: LibraryStanding };
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

export interface AboutAsk {
}

export interface About {
  readonly version: string;
  readonly project: string;
  readonly sources: readonly string[];
}

export interface LibraryWatch {
  readonly type: "watch";
}
