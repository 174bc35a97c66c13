/** How far what was found is from the truth of a sample, pixel by pixel. Runs in the worker. */

import type { Estimator, Sample } from "../../pkg/index.js";
import type { ErrorMaps } from "./protocol";
import { raster, type Cut } from "./rasters";

const DEGREES = 180 / Math.PI;

/** Angles between unit normals, from the length of their difference because the cosine loses small ones. */
function angles(found: Float32Array, truth: Float32Array): Float32Array {
  return Float32Array.from({ length: found.length / 3 }, (_, i) => {
    const apart = Math.hypot(...[0, 1, 2].map((c) => (found[3 * i + c] ?? NaN) - (truth[3 * i + c] ?? NaN)));
    return 2 * Math.asin(Math.min(1, apart / 2)) * DEGREES;
  });
}

/** Depths that differ, and how far; where only differences of depth can be seen, the middle of both is the same. */
function apart(found: Float32Array, truth: Float32Array, free: boolean): Float32Array {
  const differences = found.map((value, i) => value - (truth[i] ?? NaN));
  const sorted = differences.filter(Number.isFinite).sort();
  const middle = free ? (sorted[Math.floor(sorted.length / 2)] ?? 0) : 0;
  return differences.map((difference) => Math.abs(difference - middle));
}

export function errorMaps(estimator: Estimator, truth: Sample["truth"], imageCut: Cut, depthCut: Cut): ErrorMaps {
  return {
    imageNormals: raster(angles(estimator.imageNormals(), truth.imageNormals), 1, imageCut),
    imageDepth: raster(apart(estimator.imageDepth(), truth.imageDepth, true), 1, imageCut),
    refinedDepth: raster(apart(estimator.refinedDepth(), truth.depth, false), 1, depthCut),
  };
}
