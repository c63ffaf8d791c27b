// The studio's messages, made by tools/make_studio_types.py from src/fdvv/studio/_messages_*.py.

export interface Calls {
  readonly "editor.achievable": { readonly ask: AchievableAsk; readonly answer: Achievable };
  readonly "editor.button": { readonly ask: ButtonAsk; readonly answer: ButtonTold };
  readonly "editor.measured": { readonly ask: MeasuredAsk; readonly answer: Measured };
  readonly "editor.rigs": { readonly ask: RigsAsk; readonly answer: Rigs };
  readonly "studio.about": { readonly ask: AboutAsk; readonly answer: About };
}

export interface Channels {
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

export interface AboutAsk {
}

export interface About {
  readonly version: string;
  readonly project: string;
  readonly sources: readonly string[];
}
