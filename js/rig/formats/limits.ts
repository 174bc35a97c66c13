/** What is too large to be a frame of a rig, refused before anything is made of it. */
import { badFile } from "../../errors.js";

/** Pixels on a side, as for all images of the package. */
export const MOST_SIDE = 4096;
/** Bytes of a file: 4096x4096 pixels of 16 bits and twice that; a cloud of 1280x960 pixels as text. */
export const MOST_BYTES = 64 * 2 ** 20;
/** What is compressed may be longer than twice what it was made of by so many bytes, and no more. */
export const OVERHEAD = 1024;
/** Cameras and poses of a file. */
export const MOST_FOUND = 5000;
/** Characters of a text that holds cameras or poses; a trajectory of ten thousand poses has a million. */
export const MOST_TEXT = 4 * 2 ** 20;

export function checkSize(width: number, height: number): void {
  const isSide = (side: number) => Number.isInteger(side) && side > 0;
  if (!isSide(width) || !isSide(height)) throw badFile(`it says that it is ${width}x${height} pixels large`);
  if (width > MOST_SIDE || height > MOST_SIDE)
    throw badFile(`it is ${width}x${height} pixels large; up to ${MOST_SIDE} on a side are read`, undefined, {
      problem: "too-large",
      width,
      height,
    });
}

/** Checks what is declared against what is there. */
export function checkBytes(needed: number, there: number, what: string): void {
  if (there < needed) throw badFile(`${what} is cut off: ${there} of ${needed} bytes`);
}
