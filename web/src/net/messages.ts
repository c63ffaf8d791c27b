// The studio's messages, made by tools/make_studio_types.py from src/fdvv/studio/_messages_*.py.

export interface Calls {
  readonly "press.list": { readonly ask: PressListAsk; readonly answer: PressList };
  readonly "press.trace": { readonly ask: TraceReadAsk; readonly answer: TraceRead };
  readonly "studio.about": { readonly ask: AboutAsk; readonly answer: About };
}

export interface Channels {
  readonly "press": { readonly asks: PressStart | PressLead | PressPush | PressLift | PressReplay | PressHostEvent | PressHere | PressPause | PressStop | PressFail | PressClear; readonly tells: PressReady | PressMeant | PressFrame | PressRefused | PressOver };
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

export interface AboutAsk {
}

export interface About {
  readonly version: string;
  readonly project: string;
  readonly sources: readonly string[];
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
