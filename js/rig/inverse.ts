/**
 * Depths of stored numbers that are larger where a surface is nearer: disparities of a stereo pair, inverse depths, what networks estimate
 * from a single image.
 *
 * Limits: a network's inverse depths have an unknown offset as well as an unknown factor; an offset that is not given is taken to be zero.
 */
import { isThere } from "./guess.js";
import { median } from "./statistics.js";

/** Depths are `numerator` / (stored number + `offset`). */
export interface InverseDepth {
  /**
   * Metres times stored numbers: focal length (pixels) times baseline (metres) for disparities in pixels, 1 for inverse metres. Default: a
   * factor at which the median depth is as far away, in pixels, as the longer side of the map is long, which suits orthographic views alone.
   */
  numerator?: number;
  /** What is added to each stored number, such as the `doffs` of Middlebury's calibrations. Default 0. */
  offset?: number;
}

/** The depths of a map of stored numbers; zero is a hole, and so is a depth that is not positive and finite. */
export function depthsOf(
  stored: ArrayLike<number>,
  { width, height }: { width: number; height: number },
  { numerator, offset = 0 }: InverseDepth,
): Float32Array {
  const shifted = Float64Array.from(stored, (value) => (isThere(value) ? value + offset : NaN));
  const factor = numerator ?? Math.max(width, height) * median(shifted.filter((value) => value > 0));
  return Float32Array.from(shifted, (value) => {
    const depth = factor / value;
    return isThere(depth) ? depth : 0;
  });
}
