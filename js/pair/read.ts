/**
 * Reads the files of a pair with the readers of rigs. A run also accepts larger pictures, which are scaled down, and colour images in formats
 * that only the browser knows.
 */
import { BimodalError, badFile, badNamed, reasonOf } from "../errors.js";
import { isNpy } from "../npy.js";
import { isPng } from "../png.js";
import { byBrowser } from "../rig/formats/jpeg.js";
import { npyPicture } from "../rig/formats/npy.js";
import type { Picture } from "../rig/formats/picture.js";
import { pngPicture } from "../rig/formats/png.js";
import { ofPicture, readRigFile } from "../rig/read.js";
import type { NamedFile, ReadOptions, RigReading } from "../rig/types.js";

/** Largest number of pixels of a picture: a photograph of 12000x9000 has 108 million, and a larger canvas exhausts memory. */
const MOST_PIXELS = 2 ** 27;

function checkPixels(width: number, height: number): void {
  if (width * height > MOST_PIXELS)
    throw badFile(`it has ${width}x${height} pixels; up to ${MOST_PIXELS} pixels are supported`);
}

/** A picture of any size that fits into memory. */
async function picture(bytes: Uint8Array, isColour: boolean): Promise<Picture> {
  if (isPng(bytes)) return pngPicture(bytes, checkPixels);
  if (isNpy(bytes)) return npyPicture(bytes, checkPixels);
  if (isColour) return byBrowser(bytes, "picture", checkPixels);
  throw badFile("it is too large for its format; save it as a PNG or a .npy file");
}

/** Reads one of the two files of a pair. */
export async function readPart(file: NamedFile, options: ReadOptions): Promise<RigReading> {
  try {
    return await readRigFile(file, options);
  } catch (error) {
    const problem = error instanceof BimodalError ? error.details?.problem : undefined;
    const isColour = options.as === undefined || options.as === "colour";
    if (problem !== "too-large" && !(problem === "picture" && isColour)) throw error;
    try {
      return { name: file.name, ...ofPicture(file.name, await picture(file.bytes, isColour), options) };
    } catch (other) {
      throw badNamed(file.name, reasonOf(other), other);
    }
  }
}
