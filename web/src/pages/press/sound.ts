/** The click: a vibration's own samples, played when the simulated cap begins to shake. */

import { acceleration_m_s2 } from "../../math";
import type { ShakeSignal } from "../../net/messages";

/** Acceleration that fills the loudspeaker at full volume. */
const FULL_m_s2 = 20;
/** Speed of a press at which a click is as loud as its model says. */
const AS_MODELLED_mm_s = 100;
/** What a moment of the simulation is heard after it was reported; steadies what the network does not. */
const DELAY_s = 0.04;
/** Clocks that moved so far apart were stopped; between two frames good ones drift by so much at most. */
const APART_s = 0.1;
const DRIFT_s = 2e-6;
/** Silence before and after a click in a file. */
export const QUIET_s = 0.02;

/** Return how loud a press of a speed is against the model: in proportion, within a factor of three either way. */
export function loudness(velocity_mm_s: number): number {
  return Math.min(3, Math.max(1 / 3, Math.abs(velocity_mm_s) / AS_MODELLED_mm_s));
}

/** Make the samples of a signal as a buffer of a context, FULL_m_s2 as 1. */
function bufferOf(context: BaseAudioContext, signal: ShakeSignal): AudioBuffer {
  const like = { ...signal, stroke: "press" as const, velocity_mm_s: null, onset_mm: 0 };
  const count = Math.round(signal.duration_s * context.sampleRate) + 1;
  const samples = acceleration_m_s2(
    like,
    Float64Array.from({ length: count }, (_, i) => i / context.sampleRate),
  );
  const buffer = context.createBuffer(1, count, context.sampleRate);
  buffer.getChannelData(0).set(Float32Array.from(samples, (a) => a / FULL_m_s2));
  return buffer;
}

/** Play a buffer at a time of the context: the one graph for loudspeaker and file. */
function playAt(
  context: BaseAudioContext,
  to: AudioNode,
  buffer: AudioBuffer,
  at_s: number,
  gain: number,
): void {
  const source = new AudioBufferSourceNode(context, { buffer });
  const level = new GainNode(context, { gain });
  source.connect(level).connect(to);
  source.start(at_s);
}

/** Render a click as it is played, with silence around it. */
export async function rendered(
  signal: ShakeSignal,
  velocity_mm_s: number,
  rate_Hz = 48_000,
): Promise<Float32Array> {
  const count = Math.round((signal.duration_s + 2 * QUIET_s) * rate_Hz);
  const context = new OfflineAudioContext(1, count, rate_Hz);
  playAt(context, context.destination, bufferOf(context, signal), QUIET_s, loudness(velocity_mm_s));
  return (await context.startRendering()).getChannelData(0);
}

/** How far apart two clocks are, where what is read is often late but never early: the least so far, which may drift. */
export class Steady {
  private least_s: number | null = null;

  /** Take a reading. */
  take(apart_s: number): void {
    // a pause moves clocks apart for good; one late reading is put right by the next
    if (this.least_s === null || apart_s > this.least_s + APART_s) this.least_s = apart_s;
    else this.least_s = Math.min(apart_s, this.least_s + DRIFT_s);
  }

  /** Return how far apart they are by the last reading; 0 before the first. */
  now_s(): number {
    return this.least_s ?? 0;
  }

  reset(): void {
    this.least_s = null;
  }
}

/** The loudspeaker of a stage; silent until the person has touched or typed something. */
export class Clicker {
  volume = 0.6;
  muted = false;
  private context: AudioContext | null = null;
  private buffers: AudioBuffer[] = [];
  private signals: readonly ShakeSignal[] = [];
  /** From simulated time to the page's clock, and from the loudspeaker's clock to it. */
  private readonly shown = new Steady();
  private readonly heard = new Steady();

  /** The person did something: from now on there may be sound. */
  wake(): void {
    if (this.muted) return;
    if (!this.context) {
      this.context = new AudioContext({ latencyHint: "interactive" });
      this.load(this.signals);
    }
    if (this.context.state === "suspended") void this.context.resume();
  }

  load(signals: readonly ShakeSignal[]): void {
    this.signals = signals;
    this.shown.reset();
    const context = this.context;
    this.buffers = context ? signals.map((signal) => bufferOf(context, signal)) : [];
  }

  /** Follow the simulation: call with every frame's last time, as it arrives. */
  follow(now_s: number): void {
    const page_s = performance.now() / 1000;
    this.shown.take(page_s - now_s);
    if (this.context) this.heard.take(page_s - this.context.currentTime);
  }

  /** Play a slot that starts at t_s of the simulation, on the clock that follow() is given. */
  click(slot: number, t_s: number, velocity_mm_s: number): void {
    const [context, buffer] = [this.context, this.buffers[slot]];
    if (!context || !buffer || this.muted || context.state !== "running") return;
    const offset_s = this.shown.now_s() - this.heard.now_s();
    const at_s = Math.max(context.currentTime, t_s + offset_s + DELAY_s);
    playAt(context, context.destination, buffer, at_s, this.volume * loudness(velocity_mm_s));
  }

  close(): void {
    void this.context?.close();
    this.context = null;
  }
}
