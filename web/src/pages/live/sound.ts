/** Sounds: beeps of a cue, and accelerations played so that they can be compared by ear. */

import type { PlayedWave } from "../../net";

/** High at contact, low at the bottom: as on the terminal. */
export const BEEP_Hz = { contact: 880, bottom: 440 } as const;
const BEEP_s = 0.06;
const LOUDNESS = 0.5;

let context: AudioContext | null = null;

/** Return the one audio context; browsers start it with the first key or click. */
function audio(): AudioContext {
  context ??= new AudioContext();
  if (context.state === "suspended") void context.resume();
  return context;
}

/** Beep after a time, with edges that do not click. */
export function beep(frequency_Hz: number, after_s: number): void {
  const sound = audio();
  const at = sound.currentTime + after_s;
  const tone = new OscillatorNode(sound, { frequency: frequency_Hz });
  const volume = new GainNode(sound, { gain: 0 });
  volume.gain.setValueAtTime(0, at);
  volume.gain.linearRampToValueAtTime(LOUDNESS, at + BEEP_s / 4);
  volume.gain.linearRampToValueAtTime(0, at + BEEP_s);
  tone.connect(volume).connect(sound.destination);
  tone.start(at);
  tone.stop(at + BEEP_s);
}

/** The largest acceleration among waves, m/s²: what is played together keeps its relative strength. */
export function peakOf(waves: readonly PlayedWave[]): number {
  return Math.max(1e-9, ...waves.flatMap((wave) => wave.acceleration_m_s2.map(Math.abs)));
}

/** Play an acceleration; resolves when it is over. peak_m_s2 becomes the loudest. */
export function play(wave: PlayedWave, peak_m_s2: number): Promise<void> {
  const sound = audio();
  const buffer = sound.createBuffer(1, Math.max(1, wave.acceleration_m_s2.length), wave.rate_Hz);
  const samples = buffer.getChannelData(0);
  wave.acceleration_m_s2.forEach((value, i) => {
    samples[i] = (LOUDNESS * value) / peak_m_s2;
  });
  const source = new AudioBufferSourceNode(sound, { buffer });
  source.connect(sound.destination);
  return new Promise((resolve) => {
    source.onended = () => resolve();
    source.start();
  });
}
