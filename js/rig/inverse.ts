/**
 * Depths from numbers that are larger for nearer surfaces: disparities of a stereo pair, inverse depths, estimates of a network from a single
 * image.
 *
 * Limits: a network's inverse depths have an unknown offset as well as an unknown factor; the offset defaults to zero.
 */
import { isThere } from "./guess.js";
import { median } from "./statistics.js";

/** Depths are `numerator` / (stored number + `offset`). */
export interface InverseDepth {
  /**
   * Metres times stored numbers: focal length (pixels) times baseline (metres) for disparities in pixels, 1 for inverse metres. Default: a
   * factor that makes the median depth as many pixels as the longer side of the map, which suits orthographic views only.
   */
  numerator?: number;
  /** The number that is added to each stored number, such as the `doffs` of Middlebury's calibrations. Default 0. */
  offset?: number;
}

/** The depths of a map of stored numbers. Zero, and a depth that is not positive and finite, is a hole. */
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
