/** Samples as a WAV file: one channel of 32-bit floats. */

const HEAD_bytes = 44;
const FLOATS = 3;

export function wavOf(samples: Float32Array, rate_Hz: number): Blob {
  const view = new DataView(new ArrayBuffer(HEAD_bytes + 4 * samples.length));
  const text = (at: number, letters: string) =>
    [...letters].forEach((c, i) => view.setUint8(at + i, c.charCodeAt(0)));
  text(0, "RIFF");
  view.setUint32(4, view.byteLength - 8, true);
  text(8, "WAVEfmt ");
  view.setUint32(16, 16, true);
  view.setUint16(20, FLOATS, true);
  view.setUint16(22, 1, true);
  view.setUint32(24, rate_Hz, true);
  view.setUint32(28, 4 * rate_Hz, true);
  view.setUint16(32, 4, true);
  view.setUint16(34, 32, true);
  text(36, "data");
  view.setUint32(40, 4 * samples.length, true);
  samples.forEach((sample, i) => view.setFloat32(HEAD_bytes + 4 * i, sample, true));
  return new Blob([view.buffer as ArrayBuffer], { type: "audio/wav" });
}
