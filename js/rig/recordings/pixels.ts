/**
 * Decodes the image encodings of ROS and the raw formats of cameras into rasters of grey or RGB.
 *
 * Bayer patterns are interpolated bilinearly; chroma samples are repeated.
 */
import { badFile } from "../../errors.js";
import { checkBytes, checkSize } from "../formats/limits.js";
import type { Picture } from "../formats/picture.js";

/** An image as a message stores it. */
export interface Stored {
  width: number;
  height: number;
  /** Bytes from one row to the next. */
  step: number;
  encoding: string;
  isBigEndian: boolean;
  data: Uint8Array;
}

/** The number of samples of a pixel, and the places of red, green and blue among them. */
interface Layout {
  bits: 8 | 16 | 32;
  samples: number;
  order: readonly number[];
}

const LAYOUTS: Record<string, Layout> = {
  rgb8: { bits: 8, samples: 3, order: [0, 1, 2] },
  bgr8: { bits: 8, samples: 3, order: [2, 1, 0] },
  rgba8: { bits: 8, samples: 4, order: [0, 1, 2] },
  bgra8: { bits: 8, samples: 4, order: [2, 1, 0] },
  rgb16: { bits: 16, samples: 3, order: [0, 1, 2] },
  bgr16: { bits: 16, samples: 3, order: [2, 1, 0] },
  rgba16: { bits: 16, samples: 4, order: [0, 1, 2] },
  bgra16: { bits: 16, samples: 4, order: [2, 1, 0] },
  mono8: { bits: 8, samples: 1, order: [0] },
  mono16: { bits: 16, samples: 1, order: [0] },
  "8uc1": { bits: 8, samples: 1, order: [0] },
  "8uc3": { bits: 8, samples: 3, order: [2, 1, 0] },
  "8uc4": { bits: 8, samples: 4, order: [2, 1, 0] },
  "16uc1": { bits: 16, samples: 1, order: [0] },
  "32fc1": { bits: 32, samples: 1, order: [0] },
};
/** The colours of a Bayer pattern in a block of 2x2: 0 red, 1 green, 2 blue. */
const BAYER: Record<string, readonly number[]> = {
  bayer_rggb: [0, 1, 1, 2],
  bayer_bggr: [2, 1, 1, 0],
  bayer_gbrg: [1, 2, 0, 1],
  bayer_grbg: [1, 0, 2, 1],
};
/** Places of the luma of two pixels and of their common chroma in four bytes. */
const PACKED: Record<string, readonly [y0: number, y1: number, u: number, v: number]> = {
  yuv422: [1, 3, 0, 2],
  uyvy: [1, 3, 0, 2],
  yuv422_yuy2: [0, 2, 1, 3],
  yuyv: [0, 2, 1, 3],
  yuy2: [0, 2, 1, 3],
};
/** Formats with a plane of luma before rows of chroma at half the width: how many pixel rows share a chroma row, and whether v comes first. */
const PLANAR: Record<string, readonly [rows: number, vFirst: boolean]> = {
  nv12: [2, false],
  nv21: [2, true],
  nv16: [1, false],
};

const keyOf = (encoding: string): string => encoding.trim().toLowerCase();
/** The pattern of a Bayer encoding of 8 or 16 bits. */
const bayerOf = (key: string): readonly number[] | undefined => BAYER[key.replace(/(8|16)$/, "")];

/** Whether images of this encoding have one number for each pixel that may be a depth. */
export const mayBeDepth = (encoding: string): boolean => /^(16uc1|32fc1|mono16|b16g)$/.test(keyOf(encoding));
export const isColoured = (encoding: string): boolean => {
  const key = keyOf(encoding);
  return (LAYOUTS[key]?.samples ?? 0) >= 3 || bayerOf(key) !== undefined || key in PACKED || key in PLANAR;
};
export const isKnown = (encoding: string): boolean =>
  keyOf(encoding) in LAYOUTS || isColoured(encoding) || keyOf(encoding) === "b16g";

/** The samples of all rows, without padding, in the byte order of this machine. */
function samples(stored: Stored, bits: 8 | 16 | 32, perRow: number): Uint8Array | Uint16Array | Float32Array {
  const { height, step, data, isBigEndian } = stored;
  const size = bits / 8;
  const row = perRow * size;
  const stride = step === 0 ? row : step;
  if (stride < row) throw badFile(`its image declares rows of ${stride} bytes; ${stored.encoding} needs ${row}`);
  checkBytes((height - 1) * stride + row, data.length, "its image");
  const found =
    bits === 8
      ? new Uint8Array(perRow * height)
      : bits === 16
        ? new Uint16Array(perRow * height)
        : new Float32Array(perRow * height);
  const bytes = new Uint8Array(found.buffer);
  for (let y = 0; y < height; y++) bytes.set(data.subarray(y * stride, y * stride + row), y * row);
  if (isBigEndian && size > 1) for (let at = 0; at < bytes.length; at += size) bytes.subarray(at, at + size).reverse();
  return found;
}

function ofLayout(stored: Stored, { bits, samples: count, order }: Layout): Picture {
  const { width, height } = stored;
  const found = samples(stored, bits, width * count);
  const channels = order.length;
  if (count === 1) return picture(stored, found, 1, bits);
  const data = bits === 16 ? new Uint16Array(channels * width * height) : new Uint8Array(channels * width * height);
  for (let pixel = 0; pixel < width * height; pixel++)
    for (let channel = 0; channel < channels; channel++)
      data[channels * pixel + channel] = found[count * pixel + (order[channel] ?? 0)] ?? 0;
  return picture(stored, data, channels, bits);
}

const picture = (
  { width, height, encoding }: Pick<Stored, "width" | "height" | "encoding">,
  data: Picture["data"],
  channels: number,
  bits: number,
): Picture => ({ width, height, channels, data, bits, format: encoding, notes: [], warnings: [] });

/** Bilinear: each missing colour of a pixel is the mean of the samples of that colour among its neighbours. */
function ofBayer(stored: Stored, pattern: readonly number[]): Picture {
  const { width, height } = stored;
  const bits = /16$/.test(stored.encoding) ? 16 : 8;
  const raw = samples(stored, bits, width);
  const data = bits === 16 ? new Uint16Array(3 * width * height) : new Uint8Array(3 * width * height);
  const sums = [0, 0, 0];
  const counts = [0, 0, 0];
  for (let y = 0; y < height; y++)
    for (let x = 0; x < width; x++) {
      sums.fill(0);
      counts.fill(0);
      for (let v = Math.max(0, y - 1); v <= Math.min(height - 1, y + 1); v++)
        for (let u = Math.max(0, x - 1); u <= Math.min(width - 1, x + 1); u++) {
          const colour = pattern[2 * (v & 1) + (u & 1)] ?? 0;
          sums[colour] = (sums[colour] ?? 0) + (raw[v * width + u] ?? 0);
          counts[colour] = (counts[colour] ?? 0) + 1;
        }
      const at = 3 * (y * width + x);
      for (let colour = 0; colour < 3; colour++) data[at + colour] = (sums[colour] ?? 0) / (counts[colour] || 1);
      const own = pattern[2 * (y & 1) + (x & 1)] ?? 0;
      data[at + own] = raw[y * width + x] ?? 0;
    }
  return picture(stored, data, 3, bits);
}

const limited = (value: number): number => (value < 0 ? 0 : value > 255 ? 255 : value);

/** BT.601 at full range, as of webcams and JPEG. */
function setYuv(data: Uint8Array, at: number, y: number, u: number, v: number): void {
  data[at] = limited(y + 1.402 * (v - 128));
  data[at + 1] = limited(y - 0.344136 * (u - 128) - 0.714136 * (v - 128));
  data[at + 2] = limited(y + 1.772 * (u - 128));
}

function ofPacked(stored: Stored, [y0, y1, u, v]: readonly [number, number, number, number]): Picture {
  const { width, height } = stored;
  if (width % 2 !== 0) throw badFile(`its image is ${width} pixels wide; ${stored.encoding} needs an even width`);
  const raw = samples(stored, 8, 2 * width);
  const data = new Uint8Array(3 * width * height);
  for (let at = 0; at < raw.length; at += 4) {
    const [chromaU, chromaV] = [raw[at + u] ?? 0, raw[at + v] ?? 0];
    const to = (3 * at) / 2;
    setYuv(data, to, raw[at + y0] ?? 0, chromaU, chromaV);
    setYuv(data, to + 3, raw[at + y1] ?? 0, chromaU, chromaV);
  }
  return picture(stored, data, 3, 8);
}

function ofPlanar(stored: Stored, [rows, vFirst]: readonly [number, boolean]): Picture {
  const { width, height, data: raw } = stored;
  const step = stored.step >= width && stored.step < 2 * width ? stored.step : width;
  checkBytes(step * height + step * Math.floor(height / rows), raw.length, "its image");
  const data = new Uint8Array(3 * width * height);
  for (let y = 0; y < height; y++)
    for (let x = 0; x < width; x++) {
      const chroma = step * height + Math.floor(y / rows) * step + (x & ~1);
      const [first, second] = [raw[chroma] ?? 128, raw[chroma + 1] ?? 128];
      setYuv(data, 3 * (y * width + x), raw[y * step + x] ?? 0, vFirst ? second : first, vFirst ? first : second);
    }
  return picture(stored, data, 3, 8);
}

export function pixels(stored: Stored): Picture {
  checkSize(stored.width, stored.height);
  const key = keyOf(stored.encoding);
  if (key === "b16g") return ofLayout({ ...stored, isBigEndian: true }, LAYOUTS.mono16 as Layout);
  const layout = LAYOUTS[key];
  if (layout) return ofLayout(stored, layout);
  const [bayer, packed, planar] = [bayerOf(key), PACKED[key], PLANAR[key]];
  if (bayer) return ofBayer(stored, bayer);
  if (packed) return ofPacked(stored, packed);
  if (planar) return ofPlanar(stored, planar);
  throw badFile(`its images are stored as "${stored.encoding.slice(0, 40)}", which is not supported`);
}
