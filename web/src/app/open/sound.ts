/** Sounds as the server reads them: WAV files of 16 bits and one channel. */

import { wavOf } from "../../math/wav";
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
  return {
    name: `${stem}.wav`,
    file: new File([wavOf(mixed(sound), sound.sampleRate, "int16")], `${stem}.wav`),
  };
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
