/** Sounds as the server reads them: WAV files of 16 bits and one channel. */

import type { Picked } from "./collect";

const HEAD_bytes = 44;
const RATE_Hz = 48_000;
const MOST_s = 10;

export function isSound({ name }: Picked): boolean {
  return /\.(wav|mp3|ogg|oga|opus|flac|m4a|aac)$/i.test(name);
}

/** Return a sound as such a WAV file; one that is one stays as it is. Throws one line. */
export async function asWav({ name, file }: Picked): Promise<Picked> {
  const data = await file.arrayBuffer();
  if (isPlain(data)) return { name, file };
  let sound: AudioBuffer;
  try {
    sound = await new OfflineAudioContext(1, 1, RATE_Hz).decodeAudioData(data);
  } catch {
    throw new Error(`${name}: this browser cannot decode it; save it as a WAV file and drop that`);
  }
  if (sound.duration > MOST_s)
    throw new Error(`${name}: it lasts ${sound.duration.toFixed(0)} s; cut one snap of a second out of it`);
  const stem = name.replace(/\.[^.]*$/, "");
  return { name: `${stem}.wav`, file: new File([wavOf(mixed(sound), sound.sampleRate)], `${stem}.wav`) };
}

function isPlain(data: ArrayBuffer): boolean {
  if (data.byteLength < HEAD_bytes) return false;
  const view = new DataView(data);
  const [riff, channels, bits] = [view.getUint32(0), view.getUint16(22, true), view.getUint16(34, true)];
  return riff === 0x52494646 && channels === 1 && bits === 16;
}

/** The mean of the channels. */
function mixed(sound: AudioBuffer): Float32Array {
  const mean = new Float32Array(sound.length);
  for (let channel = 0; channel < sound.numberOfChannels; channel++)
    sound.getChannelData(channel).forEach((value, i) => {
      mean[i]! += value / sound.numberOfChannels;
    });
  return mean;
}

/** Write samples of -1 to 1 as a WAV file of 16 bits. */
export function wavOf(samples: Float32Array, rate_Hz: number): ArrayBuffer {
  const view = new DataView(new ArrayBuffer(HEAD_bytes + 2 * samples.length));
  const text = (at: number, letters: string) =>
    [...letters].forEach((c, i) => view.setUint8(at + i, c.charCodeAt(0)));
  text(0, "RIFF");
  view.setUint32(4, view.byteLength - 8, true);
  text(8, "WAVEfmt ");
  view.setUint32(16, 16, true);
  view.setUint16(20, 1, true);
  view.setUint16(22, 1, true);
  view.setUint32(24, rate_Hz, true);
  view.setUint32(28, 2 * rate_Hz, true);
  view.setUint16(32, 2, true);
  view.setUint16(34, 16, true);
  text(36, "data");
  view.setUint32(40, 2 * samples.length, true);
  samples.forEach((sample, i) =>
    view.setInt16(HEAD_bytes + 2 * i, Math.round(32767 * Math.max(-1, Math.min(1, sample))), true),
  );
  return view.buffer as ArrayBuffer;
}
