/** The click: a vibration's own samples, played when the simulated cap begins to shake. */

import { vibrationSamples } from "../../math";
import type { ShakeSignal } from "../../net/messages";

/** Acceleration that fills the loudspeaker at full volume. */
export const FULL_m_s2 = 20;
/** Speed of a press at which a click is as loud as its model says. */
export const AS_MODELLED_mm_s = 100;
/** What a moment of the simulation is heard after it was told; steadies what the network does not. */
export const DELAY_s = 0.03;
/** Silence before and after a click in a file. */
export const QUIET_s = 0.02;

/** Give how loud a press of a speed is against the model: in proportion, within a factor of three either way. */
export function loudness(velocity_mm_s: number): number {
  return Math.min(3, Math.max(1 / 3, Math.abs(velocity_mm_s) / AS_MODELLED_mm_s));
}

/** Make the samples of a signal as a buffer of a context, FULL_m_s2 as 1. */
export function bufferOf(context: BaseAudioContext, signal: ShakeSignal): AudioBuffer {
  const like = { ...signal, stroke: "press" as const, velocity_mm_s: null, onset_mm: 0 };
  const samples = vibrationSamples(like, context.sampleRate, 0);
  const buffer = context.createBuffer(1, Math.max(1, samples.length), context.sampleRate);
  buffer.getChannelData(0).set(Float32Array.from(samples, (a) => a / FULL_m_s2));
  return buffer;
}

/** Play a buffer at a time of the context: the one graph for loudspeaker and file. */
export function playAt(context: BaseAudioContext, to: AudioNode, buffer: AudioBuffer, at_s: number, gain: number): void {
  const source = new AudioBufferSourceNode(context, { buffer });
  const level = new GainNode(context, { gain });
  source.connect(level).connect(to);
  source.start(at_s);
}

/** Render a click as it is played, with silence around it. */
export async function rendered(signal: ShakeSignal, velocity_mm_s: number, rate_Hz = 48_000): Promise<Float32Array> {
  const count = Math.round((signal.duration_s + 2 * QUIET_s) * rate_Hz);
  const context = new OfflineAudioContext(1, count, rate_Hz);
  playAt(context, context.destination, bufferOf(context, signal), QUIET_s, loudness(velocity_mm_s));
  return (await context.startRendering()).getChannelData(0);
}

/** Where a simulated time is on the loudspeaker's clock: the quickest frame so far tells how late all are. */
export class SoundClock {
  private ahead_s: number | null = null;

  /** A frame that ends at now_s was told at audio_s. Gives the offset from simulated to audio time. */
  heard(now_s: number, audio_s: number): number {
    const found = audio_s - now_s;
    // time that was dropped, or a pause, moves the clocks apart for good
    const jumped = this.ahead_s !== null && Math.abs(found - this.ahead_s) > 0.1;
    if (this.ahead_s === null || jumped) this.ahead_s = found;
    else this.ahead_s = Math.min(found, this.ahead_s + 1e-4);
    return this.ahead_s;
  }

  reset(): void {
    this.ahead_s = null;
  }
}

/** The loudspeaker of a stage; silent until the person has touched or typed something. */
export class Clicker {
  volume = 0.6;
  muted = false;
  private context: AudioContext | null = null;
  private buffers: AudioBuffer[] = [];
  private signals: readonly ShakeSignal[] = [];
  private readonly clock = new SoundClock();

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
    this.clock.reset();
    const context = this.context;
    this.buffers = context ? signals.map((signal) => bufferOf(context, signal)) : [];
  }

  /** Follow the simulation: call with every frame's last time. */
  follow(now_s: number): void {
    if (this.context) this.clock.heard(now_s, this.context.currentTime);
  }

  /** Play a slot that starts at t_s of the simulation, which stands at now_s. */
  click(slot: number, t_s: number, now_s: number, velocity_mm_s: number): void {
    const [context, buffer] = [this.context, this.buffers[slot]];
    if (!context || !buffer || this.muted || context.state !== "running") return;
    const offset_s = this.clock.heard(now_s, context.currentTime);
    const at_s = Math.max(context.currentTime, offset_s + t_s + DELAY_s);
    playAt(context, context.destination, buffer, at_s, this.volume * loudness(velocity_mm_s));
  }

  close(): void {
    void this.context?.close();
    this.context = null;
  }
}
