/**
 * Image and depth files without a canvas, which would throw away the lower byte of 16 bits and premultiply alpha: PNG of
 * 8 and 16 bits, and NumPy's .npy. A module of its own, to be loaded when the first file comes in.
 */
import { BimodalError, badFile } from "./errors.js";
import { type Raster, isNpy, readNpy } from "./npy.js";
import { isPng, readPng } from "./png.js";
import { type Pixels, single, toColour, toMask } from "./raster.js";
import type { ColorImage, DepthMap, Mask } from "./types.js";

export { BimodalError };

type Bytes = Uint8Array | ArrayBuffer;

function read(file: Bytes): Raster<Pixels> {
  const bytes = file instanceof Uint8Array ? file : new Uint8Array(file);
  if (bytes.length === 0) throw badFile("it is empty");
  const raster = isNpy(bytes) ? readNpy(bytes) : isPng(bytes) ? readPng(bytes) : undefined;
  if (raster === undefined) throw badFile("it is neither a PNG nor a .npy file");
  return raster;
}

/** A colour image: PNG, or .npy of rows x columns (x 3 or 4), floats being linear. */
export const decodeColour = (file: Bytes): ColorImage => toColour(read(file));

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
    throw badFile(`a depth map has 1 channel and a cloud 3, not ${channels}`);
  }
  return { width, height, data: new Uint16Array(single(raster)) };
}

/** A mask: whatever is neither zero nor transparent belongs to the object. */
export const decodeMask = (file: Bytes): Mask => toMask(read(file));
