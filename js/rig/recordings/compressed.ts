/**
 * Images compressed by image_transport: JPEG, PNG and WebP, and the depth maps of compressed_depth_image_transport, a head of twelve bytes
 * before a PNG or RVL data (Wilson, "Fast lossless depth image compression", 2017). 32-bit depths are a / (stored - b).
 */
import { badFile } from "../../errors.js";
import { readJpeg, readWebp } from "../formats/jpeg.js";
import { kindOf } from "../formats/kinds.js";
import { checkSize } from "../formats/limits.js";
import type { Picture } from "../formats/picture.js";
import { pngPicture } from "../formats/png.js";

const HEAD = 12;

export const isCompressedDepth = (format: string): boolean => /compressedDepth/i.test(format);

/**
 * Numbers in nibbles: three bits and a bit for "more follows", lowest bits first, in 32-bit words that are read from the highest nibble.
 */
class Nibbles {
  readonly #view: DataView;
  #at = 0;
  #word = 0;
  #left = 0;

  constructor(bytes: Uint8Array) {
    this.#view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  }

  number(): number {
    let value = 0;
    for (let shift = 0; ; shift += 3) {
      if (shift > 29) throw badFile("its compressed depth is damaged (RVL)");
      if (this.#left === 0) {
        this.#word = this.#view.getUint32(this.#at, true);
        this.#at += 4;
        this.#left = 8;
      }
      const nibble = this.#word >>> 28;
      this.#word = (this.#word << 4) >>> 0;
      this.#left--;
      value |= (nibble & 7) << shift;
      if ((nibble & 8) === 0) return value >>> 0;
    }
  }
}

/** RVL: runs of zeros, and runs of zigzag-coded differences from the previous depth. */
function rvl(bytes: Uint8Array): Picture {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  const [width, height] = [view.getUint32(0, true), view.getUint32(4, true)];
  checkSize(width, height);
  const nibbles = new Nibbles(bytes.subarray(8));
  const data = new Uint16Array(width * height);
  let [at, previous] = [0, 0];
  while (at < data.length) {
    at += nibbles.number();
    let run = nibbles.number();
    if (at + run > data.length) throw badFile("its compressed depth is damaged (RVL)");
    for (; run > 0; run--) {
      const zigzag = nibbles.number();
      previous += (zigzag >>> 1) ^ -(zigzag & 1);
      data[at++] = previous;
    }
  }
  return { width, height, channels: 1, data, bits: 16, format: "RVL", notes: [], warnings: [] };
}

/** Depths in metres from quantised inverse depths. */
function inverted(found: Picture, a: number, b: number): Picture {
  const data = new Float32Array(found.width * found.height);
  for (let at = 0; at < data.length; at++) {
    const value = found.data[at] ?? 0;
    data[at] = value > 0 ? a / (value - b) : NaN;
  }
  return { ...found, data, bits: 32 };
}

export async function compressedDepth(format: string, bytes: Uint8Array): Promise<Picture> {
  if (bytes.length <= HEAD) throw badFile("its compressed depth is cut off");
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  const body = bytes.subarray(HEAD);
  const found = kindOf(body) === "png" ? await pngPicture(body) : rvl(body);
  if (found.channels !== 1 || found.bits !== 16)
    throw badFile(
      `its compressed depth has ${found.channels} channels of ${found.bits} bits; one channel of 16 bits is needed`,
    );
  return /32FC1/i.test(format) ? inverted(found, view.getFloat32(4, true), view.getFloat32(8, true)) : found;
}

/** The picture, recognised by its content: the format string differs between versions of image_transport. */
export async function compressed(bytes: Uint8Array, format: string): Promise<Picture> {
  const kind = kindOf(bytes);
  if (kind === "jpeg") return readJpeg(bytes);
  if (kind === "png") return pngPicture(bytes);
  if (kind === "webp") return readWebp(bytes);
  throw badFile(
    `its images are compressed as "${format.slice(0, 40)}", which is not supported; only JPEG, PNG and WebP are`,
  );
}
