/** The whole factor by which an image is finer than a run can use with its depth map: that of src/view/working_size.rs, rounded down. */
import type { ColorImage, DepthMap } from "../types/index.js";

/** Images of more pixels are scaled down before the run: drawing and keeping results of that size takes longer than the run. */
const LARGE = 2 ** 20;
/** Tolerance for rounding in ratios that are whole numbers. */
const ROUNDING = 1e-6;

const focalLength = ({ fx, fy }: { fx: number; fy: number }): number => Math.sqrt(fx * fy);

function measured({ width, height, data, points, mask }: DepthMap): number {
  let count = 0;
  for (let pixel = 0; pixel < width * height; pixel++) {
    if (mask !== undefined && mask[pixel] === 0) continue;
    const value = points ? (points[3 * pixel + 2] ?? NaN) : (data?.[pixel] ?? NaN);
    if (Number.isFinite(value) && (points !== undefined || value > 0)) count++;
  }
  return count;
}

const ratio = (fine: number, coarse: number): number => Math.sqrt(fine / Math.max(1, coarse));

/** The ratio of the image's resolution to the depth map's, at the object. */
export function finerBy(image: ColorImage, depth: DepthMap): number {
  const frames = ratio(image.width * image.height, depth.width * depth.height);
  if (image.camera && depth.camera) return Math.min(frames, focalLength(image.camera) / focalLength(depth.camera));
  if (image.mask === undefined) return frames;
  let inside = 0;
  for (const value of image.mask) if (value > 0) inside++;
  return Math.min(frames, ratio(inside, measured(depth)));
}

/** The factor by which a large image of this ratio is scaled down before a run; 1 leaves it. */
export function surplus({ width, height }: ColorImage, finer: number): number {
  return width * height <= LARGE ? 1 : Math.max(1, Math.floor(finer + ROUNDING));
}
