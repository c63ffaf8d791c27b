/** Samples as the bytes of a WAV file of one channel. */

const HEAD_bytes = 44;

/** How a sample is written: the format's number, its bytes, and the setter of one value. */
const SAMPLES = {
  int16: {
    format: 1,
    bytes: 2,
    set: (view: DataView, at: number, sample: number) =>
      view.setInt16(at, Math.round(32767 * Math.max(-1, Math.min(1, sample))), true),
  },
  float32: {
    format: 3,
    bytes: 4,
    set: (view: DataView, at: number, sample: number) => view.setFloat32(at, sample, true),
  },
} as const;

/** Write samples: int16 holds -1 to 1, float32 any number. */
export function wavOf(samples: Float32Array, rate_Hz: number, as: keyof typeof SAMPLES): ArrayBuffer {
  const { format, bytes, set } = SAMPLES[as];
  const file = new ArrayBuffer(HEAD_bytes + bytes * samples.length);
  const view = new DataView(file);
  const text = (at: number, letters: string) =>
    [...letters].forEach((c, i) => view.setUint8(at + i, c.charCodeAt(0)));
  text(0, "RIFF");
  view.setUint32(4, view.byteLength - 8, true);
  text(8, "WAVEfmt ");
  view.setUint32(16, 16, true);
  view.setUint16(20, format, true);
  view.setUint16(22, 1, true);
  view.setUint32(24, rate_Hz, true);
  view.setUint32(28, bytes * rate_Hz, true);
  view.setUint16(32, bytes, true);
  view.setUint16(34, 8 * bytes, true);
  text(36, "data");
  view.setUint32(40, bytes * samples.length, true);
  samples.forEach((sample, i) => set(view, HEAD_bytes + bytes * i, sample));
  return file;
}
