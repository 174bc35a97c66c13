/** COLMAP's images.txt with the poses of the images. */
import { badFile } from "../../errors.js";
import { type ReaderWarning, distinct, warning } from "../warnings.js";
import { linesOf } from "./colmap-lines.js";
import { numberOf } from "./numbers.js";
import { inverseOf, motion, ofScalarFirst } from "./poses.js";
import type { Calibration } from "./tree.js";

const MOST_IMAGES = 5000;

const IMAGE = /^\s*\d+(?:\s+[-+.\deE]+){7}\s+\d+\s+\S.*$/;

/** "IMAGE_ID QW QX QY QZ TX TY TZ CAMERA_ID NAME", followed by a line of the image's points. */
export const isColmapImages = (text: string): boolean => IMAGE.test(linesOf(text.slice(0, 4096))[0] ?? "");

export function readColmapImages(text: string): Calibration {
  const warnings: ReaderWarning[] = [];
  const lines = linesOf(text).filter((line) => IMAGE.test(line));
  if (lines.length > MOST_IMAGES) throw badFile(`it lists more than ${MOST_IMAGES} images`);
  const poses = lines.map((line) => {
    const [, ...words] = line.trim().split(/\s+/);
    const numbers = words.slice(0, 7).map((word) => numberOf(word) ?? NaN);
    if (numbers.some(Number.isNaN)) throw badFile(`it has a line that is not an image: ${line.slice(0, 60)}`);
    const names = { name: words.slice(8).join(" "), from: "camera", to: "world" };
    const found = motion(ofScalarFirst(numbers.slice(0, 4), warnings), numbers.slice(4), names, warnings, false);
    return { ...found, pose: inverseOf(found.pose) };
  });
  warnings.push(
    warning(
      "camera-to-world",
      `The file has the poses of ${poses.length} images in a world of unknown scale (camera to world), which were not used as extrinsics between two cameras.`,
      { poses: poses.length },
    ),
  );
  return { cameras: [], poses, warnings: distinct(warnings, 4) };
}
