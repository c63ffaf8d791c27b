// The studio's messages, made by tools/make_studio_types.py from src/fdvv/studio/_messages_*.py.

export interface Calls {
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
