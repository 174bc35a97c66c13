/** Errors against the truth of a rendered scene, measured by the same modules as in the tables. */

import {
  chosenPixels as chosen,
  depthRmse as rmse,
  normalDegrees as degrees,
} from "../../../protocols/measure-shapes.mjs";
import {
  aboutY as aboutVertical,
  angleBetween as between,
  degreesBetween as rotationBetween,
  product as times,
  turn,
} from "../../../protocols/rotations.mjs";

/** Mean angle between two fields of normals where both have one. */
export const normalDegrees = degrees as (
  found: ArrayLike<number>,
  truth: ArrayLike<number>,
  counts?: (index: number) => boolean,
) => number;
/** Depth error, root mean square, up to a constant. */
export const depthRmse = rmse as (found: Float32Array, truth: Float32Array) => number;
/** The pixels of a smaller share are also in every larger share. */
export const chosenPixels = chosen as (mask: Uint8Array, share: number, seed: number) => Uint8Array;
export const degreesBetween = rotationBetween as (found: readonly number[], truth: readonly number[]) => number;
export const angleBetween = between as (a: ArrayLike<number>, b: ArrayLike<number>) => number;
export const aboutY = aboutVertical as (degrees: number) => number[];
export const turned = turn as (rotation: readonly number[], vector: readonly number[]) => number[];
export const product = times as (a: readonly number[], b: readonly number[]) => number[];

/** Root mean square of the difference where both are known. */
export function rms(found: ArrayLike<number>, truth: ArrayLike<number>): number {
  let [sum, count] = [0, 0];
  for (let index = 0; index < found.length; index++) {
    const off = (found[index] ?? NaN) - (truth[index] ?? NaN);
    if (!Number.isFinite(off)) continue;
    sum += off * off;
    count++;
  }
  return Math.sqrt(sum / count);
}

/** Mean of the values that count. */
export function meanOf(values: ArrayLike<number>, counts: (index: number) => boolean = () => true): number {
  let [sum, number] = [0, 0];
  for (let index = 0; index < values.length; index++) {
    const value = values[index] ?? NaN;
    if (!Number.isFinite(value) || !counts(index)) continue;
    sum += value;
    number++;
  }
  return sum / number;
}

/** The share of the true differences that is recovered: the slope of the best-fitting line. */
export function slopeOf(found: ArrayLike<number>, truth: ArrayLike<number>): number {
  const both = (index: number) => Number.isFinite(found[index]) && Number.isFinite(truth[index]);
  const [f, t] = [meanOf(found, both), meanOf(truth, both)];
  let [up, down] = [0, 0];
  for (let index = 0; index < found.length; index++) {
    if (!both(index)) continue;
    const along = (truth[index] ?? 0) - t;
    up += along * ((found[index] ?? 0) - f);
    down += along * along;
  }
  return up / down;
}

/** The correlation of two rasters, -1 .. 1. */
export function correlation(a: ArrayLike<number>, b: ArrayLike<number>): number {
  const product = slopeOf(a, b) * slopeOf(b, a);
  return Math.sign(slopeOf(a, b)) * Math.sqrt(Math.max(0, product));
}
