/**
 * Image and depth files without a canvas, which would throw away the lower byte of 16 bits and premultiply alpha: PNG of
 * 8 and 16 bits, and NumPy's .npy. A module of its own, to be loaded when the first file comes in.
 */
import { convertIndexedToRgb, decode, hasPngSignature } from "fast-png";
import { BimodalError } from "./errors.js";
import { type Raster, isNpy, readNpy } from "./npy.js";
import type { ColorImage, DepthMap, Mask } from "./types.js";

export { BimodalError } from "./errors.js";

type Bytes = Uint8Array | ArrayBuffer;
type Pixels = Uint8Array | Uint16Array | Float32Array;

const bad = (message: string, cause?: unknown) => new BimodalError("file", `file: ${message}`, "file", { cause });

/** Grey levels of fewer than 8 bits lie packed, each row from a new byte; they come out one for each byte, unscaled. */
function unpack(packed: Uint8Array, width: number, height: number, bits: number): Uint8Array {
  const levels = new Uint8Array(width * height);
  const stride = Math.ceil((width * bits) / 8);
  for (let row = 0; row < height; row++) {
    for (let column = 0; column < width; column++) {
      const bit = column * bits;
      const byte = packed[row * stride + (bit >> 3)] ?? 0;
      levels[row * width + column] = (byte >> (8 - bits - (bit & 7))) & ((1 << bits) - 1);
    }
  }
  return levels;
}

function readPng(bytes: Uint8Array): Raster<Uint8Array | Uint16Array> {
  try {
    const png = decode(bytes, { checkCrc: true });
    const { width, height } = png;
    if (png.palette) return { width, height, channels: png.palette[0]?.length ?? 3, data: convertIndexedToRgb(png) };
    if (png.data instanceof Uint16Array) return { width, height, channels: png.channels, data: png.data };
    const data = new Uint8Array(png.data);
    if (png.depth < 8) {
      // Full white is 1, 3 or 15 here.
      const scale = 255 / (2 ** png.depth - 1);
      return { width, height, channels: 1, data: unpack(data, width, height, png.depth).map((level) => level * scale) };
    }
    return { width, height, channels: png.channels, data };
  } catch (error) {
    throw bad(`this PNG is damaged or cut off (${error instanceof Error ? error.message : String(error)})`, error);
  }
}

function read(file: Bytes): Raster<Pixels> {
  const bytes = file instanceof Uint8Array ? file : new Uint8Array(file);
  if (bytes.length === 0) throw bad("it is empty");
  const raster = isNpy(bytes) ? readNpy(bytes) : hasPngSignature(bytes) ? readPng(bytes) : undefined;
  if (raster === undefined) throw bad("it is neither a PNG nor a .npy file");
  return raster;
}

const hasColour = (channels: number): boolean => channels >= 3;
const hasAlpha = (channels: number): boolean => channels === 2 || channels === 4;

/** Copies pixels into another number of channels; grey is repeated. */
function spread<T extends Pixels>(from: Raster<Pixels>, to: T, channels: number, opaque: number): T {
  const pixels = from.width * from.height;
  const last = from.channels - 1;
  for (let pixel = 0; pixel < pixels; pixel++) {
    const at = pixel * from.channels;
    for (let channel = 0; channel < 3; channel++) {
      to[pixel * channels + channel] = from.data[at + (hasColour(from.channels) ? channel : 0)] ?? 0;
    }
    if (channels === 4) to[pixel * 4 + 3] = hasAlpha(from.channels) ? (from.data[at + last] ?? 0) : opaque;
  }
  return to;
}

/** 255 where a pixel is at least half opaque; nothing where there is no alpha or all of it is. */
function alphaMask({ width, height, channels, data }: Raster<Pixels>): Uint8Array | undefined {
  if (!hasAlpha(channels) || data instanceof Float32Array) return undefined;
  const half = data instanceof Uint16Array ? 0x8000 : 0x80;
  const mask = new Uint8Array(width * height);
  for (let pixel = 0; pixel < mask.length; pixel++) {
    mask[pixel] = (data[pixel * channels + channels - 1] ?? 0) >= half ? 255 : 0;
  }
  return mask.includes(0) ? mask : undefined;
}

/** A colour image: PNG, or .npy of rows x columns (x 3 or 4), floats being linear. */
export function decodeColour(file: Bytes): ColorImage {
  const raster = read(file);
  const { width, height, data } = raster;
  const pixels = width * height;
  if (data instanceof Float32Array) return { width, height, data: spread(raster, new Float32Array(3 * pixels), 3, 1) };
  const rgba =
    data instanceof Uint16Array
      ? spread(raster, new Uint16Array(4 * pixels), 4, 0xffff)
      : spread(raster, new Uint8Array(4 * pixels), 4, 0xff);
  return { width, height, data: rgba };
}

/** The one channel of a depth map, also where a program has saved it as grey RGB. */
function single({ width, height, channels, data }: Raster<Pixels>): Pixels {
  if (channels === 1) return data;
  const levels = data instanceof Uint16Array ? new Uint16Array(width * height) : new Uint8Array(width * height);
  for (let pixel = 0; pixel < levels.length; pixel++) {
    const at = pixel * channels;
    const level = data[at] ?? 0;
    if (hasColour(channels) && (data[at + 1] !== level || data[at + 2] !== level)) {
      throw bad("a depth map has one value for each pixel, and this picture is coloured; is it a rendering of the depth?");
    }
    levels[pixel] = level;
  }
  return levels;
}

/**
 * A depth map: PNG, or .npy of rows x columns; a float .npy of rows x columns x 3 is an organised cloud. The unit is not
 * in the file: say it in `unit`.
 */
export function decodeDepth(file: Bytes): DepthMap {
  const raster = read(file);
  const { width, height, channels, data } = raster;
  if (data instanceof Float32Array) {
    if (channels === 3) return { width, height, points: data };
    if (channels === 1) return { width, height, data };
    throw bad(`a depth map has 1 channel and a cloud 3, not ${channels}`);
  }
  return { width, height, data: new Uint16Array(single(raster)) };
}

/** A mask: whatever is neither zero nor transparent belongs to the object. */
export function decodeMask(file: Bytes): Mask {
  const raster = read(file);
  const { width, height, channels, data } = raster;
  const opaque = alphaMask(raster);
  const visible = hasColour(channels) ? 3 : 1;
  const mask = new Uint8Array(width * height);
  for (let pixel = 0; pixel < mask.length; pixel++) {
    const at = pixel * channels;
    const lit = data.subarray(at, at + visible).some((value) => value > 0);
    mask[pixel] = lit && opaque?.[pixel] !== 0 ? 255 : 0;
  }
  return { width, height, data: mask };
}
