/**
 * Image and depth files: PNG of 8 and 16 bits, and NumPy's .npy. A canvas could not read them, because it drops the lower byte of 16 bits
 * and premultiplies alpha. This module is separate and loads with the first file.
 */
import { wrong } from "./check.js";
import { BimodalError, badFile } from "./errors.js";
import { type Raster, isNpy, readNpy } from "./npy.js";
import { isPng, readPng } from "./png.js";
import { type Pixels, single, toColour, toMask } from "./raster.js";
import type { ColorImage, DepthMap, Mask } from "./types/index.js";

export { BimodalError };
export { imageFrom } from "./images.js";
export type { ColorImage, DepthMap, ImageOptions, ImageSource, Mask } from "./types/index.js";

type Bytes = Uint8Array | ArrayBuffer;

/**
 * Largest number of pixels of a PNG. A photograph of 12000 x 9000 has 108 million. A small file that declares more could exhaust memory.
 */
const MOST_PIXELS = 2 ** 27;

function checkSize(width: number, height: number): void {
  if (width * height > MOST_PIXELS)
    throw badFile(`this PNG declares ${width}x${height} pixels; up to ${MOST_PIXELS} pixels are supported`);
}

function read(file: Bytes): Raster<Pixels> {
  if (!(file instanceof Uint8Array || file instanceof ArrayBuffer))
    throw wrong("file", "a Uint8Array or an ArrayBuffer", file);
  const bytes = file instanceof Uint8Array ? file : new Uint8Array(file);
  if (bytes.length === 0) throw badFile("it is empty");
  if (!isNpy(bytes) && !isPng(bytes))
    throw badFile("it is neither a PNG nor a .npy file; `bimodal-stereo/rig` reads more");
  try {
    return isNpy(bytes) ? readNpy(bytes) : readPng(bytes, checkSize);
  } catch (error) {
    if (error instanceof RangeError) throw badFile("there is not enough memory for it", error);
    throw error;
  }
}

/** A colour image: PNG, or .npy of rows x columns (x 3 or 4). Floats are linear. */
export const decodeColour = (file: Bytes): ColorImage => toColour(read(file));

/**
 * A depth map: PNG, or .npy of rows x columns; a float .npy of rows x columns x 3 is an organised cloud. The file does not state the unit;
 * set `unit`.
 */
export function decodeDepth(file: Bytes): DepthMap {
  const raster = read(file);
  const { width, height, channels, data } = raster;
  if (data instanceof Float32Array) {
    if (channels === 3) return { width, height, points: data };
    if (channels === 1) return { width, height, data };
    throw badFile(`a depth map has 1 channel and a cloud 3, not ${channels}`);
  }
  return { width, height, data: new Uint16Array(single(raster)) };
}

/** A mask: pixels that are neither zero nor transparent belong to the object. */
export const decodeMask = (file: Bytes): Mask => toMask(read(file));
