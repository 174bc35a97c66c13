/** Points in rows and columns: the cloud of a depth camera with all of its pixels. */
import { badFile } from "../../errors.js";
import { checkSize } from "./limits.js";
import { type ReaderWarning, warning } from "../warnings.js";

/** Image sizes of depth cameras. They are tried for a cloud whose file does not give rows and columns. */
export const SIZES = [
  [640, 480],
  [320, 240],
  [640, 576],
  [512, 512],
  [512, 424],
  [320, 288],
  [1280, 720],
  [848, 480],
  [640, 360],
  [480, 270],
  [424, 240],
  [1024, 768],
  [1024, 1024],
  [1280, 800],
  [640, 400],
  [1920, 1080],
  [224, 171],
  [160, 120],
] as const;

/** Largest number of points of a cloud. */
export const MOST_POINTS = 2 ** 22;

export function checkPoints(count: number): void {
  if (!Number.isInteger(count) || count < 1) throw badFile(`it declares ${count} points`);
  if (count > MOST_POINTS) throw badFile(`it declares ${count} points; up to ${MOST_POINTS} are supported`);
}

/** Whether this number of points fills an image of a depth camera. */
export const isImage = (count: number): boolean => SIZES.some(([width, height]) => width * height === count);

/** The image size that has this number of points, with a warning; throws if no such size is known. */
export function sizeOfCount(count: number, warnings: ReaderWarning[]): { width: number; height: number } {
  const size = SIZES.find(([width, height]) => width * height === count);
  if (size === undefined)
    throw badFile(
      `its ${count} points are not in rows and columns (unorganised), and too few for a range image; save it as an organised cloud or as a depth map`,
    );
  const [width, height] = size;
  warnings.push(
    warning(
      "grid-guessed",
      `The file does not give rows and columns for its ${count} points; ${width}x${height} was guessed.`,
      { width, height },
    ),
  );
  return { width, height };
}

export function checkGrid(width: number, height: number, count: number): void {
  checkSize(width, height);
  if (width * height !== count) throw badFile(`it declares ${count} points in ${width}x${height} rows and columns`);
}
