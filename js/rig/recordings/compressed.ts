/**
 * What image_transport compresses: JPEG and PNG, and depth as compressed_depth_image_transport has it, a head of twelve bytes before a PNG or
 * a run of RVL (Wilson, "Fast lossless depth image compression", 2017). 32-bit depths are stored as a / (value - b).
 */
import { badFile } from "../../errors.js";
import { readJpeg, readWebp } from "../formats/jpeg.js";
import { kindOf } from "../formats/kinds.js";
import { checkSize } from "../formats/limits.js";
import type { Picture } from "../formats/picture.js";
import { pngPicture } from "../formats/png.js";

const HEAD = 12;

export const isCompressedDepth = (format: string): boolean => /compressedDepth/i.test(format);

/** Nibbles with three bits of a number each, the lowest first, in 32-bit words whose highest nibble is the first. */
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

/** Runs of zeros and of differences to the depth before, zigzag. */
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

/** Of integers that stand for inverse depths. */
function inverted(found: Picture, a: number, b: number): Picture {
  const data = new Float32Array(found.width * found.height);
  for (let at = 0; at < data.length; at++) {
    const value = found.data[at] ?? 0;
    data[at] = value > 0 ? a / (value - b) : NaN;
  }
  return { ...found, data, bits: 32 };
}

export function compressedDepth(format: string, bytes: Uint8Array): Picture {
  if (bytes.length <= HEAD) throw badFile("its compressed depth is cut off");
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  const body = bytes.subarray(HEAD);
  const found = kindOf(body) === "png" ? pngPicture(body) : rvl(body);
  if (found.channels !== 1 || found.bits !== 16)
    throw badFile(`its compressed depth has ${found.channels} channels of ${found.bits} bits; one of 16 is needed`);
  return /32FC1/i.test(format) ? inverted(found, view.getFloat32(4, true), view.getFloat32(8, true)) : found;
}

/** By its content: what is written beside it has changed from version to version. */
export async function compressed(bytes: Uint8Array, format: string): Promise<Picture> {
  const kind = kindOf(bytes);
  if (kind === "jpeg") return readJpeg(bytes);
  if (kind === "png") return pngPicture(bytes);
  if (kind === "webp") return readWebp(bytes);
  throw badFile(
    `its pictures are compressed as "${format.slice(0, 40)}", which is not read here; JPEG, PNG and WebP are`,
  );
}
