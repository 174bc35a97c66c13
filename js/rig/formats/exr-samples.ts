/** The samples of an OpenEXR's blocks by their type. */
import { half } from "../../half.js";
import { type Header, SIZES, strideOf } from "./exr-header.js";

/** Types of samples: integers of 32 bits and floats of 16 bits; type 2 has floats of 32 bits. */
export const [WHOLE, HALF] = [0, 1];

/** The sample of this type that begins at a byte. */
export function sampleAt(view: DataView, type: number, at: number): number {
  if (type === HALF) return half(view.getUint16(at, true));
  return type === WHOLE ? view.getUint32(at, true) : view.getFloat32(at, true);
}

/** Samples of one type, one after the other. */
export function samplesOf(bytes: Uint8Array, type: number): Float32Array {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  const size = SIZES[type] ?? 0;
  return Float32Array.from({ length: Math.floor(bytes.length / size) }, (_, at) => sampleAt(view, type, at * size));
}

/** One channel of an uncompressed block. Each line has all samples of its first channel, then all of its second. */
export function channelOfLines(body: Uint8Array, header: Header, used: number, rows: number): Float32Array {
  const { width, channels } = header;
  const view = new DataView(body.buffer, body.byteOffset, body.byteLength);
  const stride = strideOf(header);
  const before = strideOf({ width, channels: channels.slice(0, used) });
  const type = channels[used]?.type ?? 0;
  const size = SIZES[type] ?? 0;
  const out = new Float32Array(width * rows);
  for (let row = 0, to = 0; row < rows; row++)
    for (let column = 0; column < width; column++)
      out[to++] = sampleAt(view, type, row * stride + before + column * size);
  return out;
}

/** Puts the samples of one channel into interleaved data with this many channels, starting at a pixel. */
export function interleave(samples: Float32Array, data: Float32Array, pixel: number, channels: number, to: number) {
  for (let at = 0; at < samples.length; at++) data[(pixel + at) * channels + to] = samples[at] ?? NaN;
}
