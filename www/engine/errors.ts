/** Errors of the results against the ground truth of a sample, pixel by pixel. Runs in the worker. */

import type { Sample } from "../../pkg/index.js";
import { quantile, someSorted } from "../draw/colours";
import type { Numbers } from "./numbers";
import type { Raster, ScaleName, Side } from "./protocol";
import { raster, type Cut } from "./rasters";

export type ErrorName = Extract<ScaleName, `${string}Error`>;

const DEGREES = 180 / Math.PI;

/** Angles between unit normals, from the length of their difference, because the cosine is inaccurate for small angles. */
function angles(found: Float32Array, truth: Float32Array): Float32Array {
  const between = new Float32Array(found.length / 3);
  for (let i = 0; i < between.length; i++) {
    const [x, y, z] = [3 * i, 3 * i + 1, 3 * i + 2];
    const squared =
      ((found[x] ?? NaN) - (truth[x] ?? NaN)) ** 2 +
      ((found[y] ?? NaN) - (truth[y] ?? NaN)) ** 2 +
      ((found[z] ?? NaN) - (truth[z] ?? NaN)) ** 2;
    between[i] = 2 * Math.asin(Math.min(1, Math.sqrt(squared) / 2)) * DEGREES;
  }
  return between;
}

/** Differences of depths; if only relative depth is determined, both medians are made equal. */
function distances(found: Float32Array, truth: Float32Array, isFree: boolean): Float32Array {
  const apart = new Float32Array(found.length);
  for (let i = 0; i < apart.length; i++) apart[i] = (found[i] ?? NaN) - (truth[i] ?? NaN);
  const middle = isFree ? (quantile(someSorted(apart), 0.5) ?? 0) : 0;
  for (let i = 0; i < apart.length; i++) apart[i] = Math.abs((apart[i] ?? NaN) - middle);
  return apart;
}

/** The ground truth of a sample in the drawn region, and the results. */
export class Errors {
  readonly #cuts: Record<Side, Cut>;
  readonly #truth: Record<ErrorName, Raster>;

  constructor({ imageNormals, imageDepth, depth }: Sample["truth"], cuts: Record<Side, Cut>) {
    this.#cuts = cuts;
    this.#truth = {
      normalError: raster(imageNormals, 3, cuts.image),
      depthError: raster(imageDepth, 1, cuts.image),
      refinementError: raster(depth, 1, cuts.depth),
    };
  }

  of(numbers: Numbers): Record<ErrorName, Raster> {
    const { normalError, depthError, refinementError } = this.#truth;
    const { image, depth } = this.#cuts;
    return {
      normalError: {
        ...normalError,
        channels: 1,
        data: angles(raster(numbers.of("imageNormals"), 3, image).data, normalError.data),
      },
      depthError: {
        ...depthError,
        data: distances(raster(numbers.of("imageDepth"), 1, image).data, depthError.data, true),
      },
      refinementError: {
        ...refinementError,
        data: distances(raster(numbers.of("refinedDepth"), 1, depth).data, refinementError.data, false),
      },
    };
  }
}
