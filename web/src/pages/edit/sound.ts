/** Vibrations through the loudspeaker: what the cap does, heard. */

import type { Vibration } from "../../model";
import { sound } from "./wave";

let output: AudioContext | null = null;

/** Play a vibration once. */
export async function playVibration(vibration: Vibration): Promise<void> {
  output ??= new AudioContext();
  await output.resume();
  const samples = sound(vibration, output.sampleRate);
  if (!samples.length) return;
  const buffer = output.createBuffer(1, samples.length, output.sampleRate);
  buffer.copyToChannel(samples, 0);
  const source = output.createBufferSource();
  source.buffer = buffer;
  source.connect(output.destination);
  source.start();
}
