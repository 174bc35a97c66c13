/** Limits on the size of files, which are checked before memory is allocated. */
import { badFile } from "../../errors.js";

/** Largest number of pixels on a side, as for all images of the package. */
export const MOST_SIDE = 4096;
/** Largest number of bytes of a file: twice those of 4096x4096 pixels of 16 bits, or a cloud of 1280x960 pixels as text. */
export const MOST_BYTES = 64 * 2 ** 20;
/** Compressed data may exceed twice their content by this many bytes. */
export const OVERHEAD = 1024;
/** Largest number of cameras, and of poses, in a file. */
export const MOST_FOUND = 5000;
/** Largest number of characters of a text that holds cameras or poses; a trajectory of ten thousand poses has a million. */
export const MOST_TEXT = 4 * 2 ** 20;

export function checkSize(width: number, height: number): void {
  const isSide = (side: number) => Number.isInteger(side) && side > 0;
  if (!isSide(width) || !isSide(height)) throw badFile(`it declares the invalid size ${width}x${height}`);
  if (width > MOST_SIDE || height > MOST_SIDE)
    throw badFile(`it has ${width}x${height} pixels; up to ${MOST_SIDE} on a side are supported`, undefined, {
      problem: "too-large",
      width,
      height,
    });
}

/** Checks that a file has the bytes that it declares. */
export function checkBytes(needed: number, there: number, what: string): void {
  if (there < needed) throw badFile(`${what} is cut off: ${there} of ${needed} bytes`);
}
