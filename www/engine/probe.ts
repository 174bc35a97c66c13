/** One pixel, its counterpart in the other view, which sees the same point, and the values of every picture there. Runs in the worker. */

import type { ColorImage } from "../../pkg/index.js";
import type { Pixel, Probed, Raster, Side } from "./protocol";
import { depthAt, placesOf } from "./rasters";
import type { Run } from "./drawings";

/**
 * Largest distance of a counterpart from its pixel, pixels of the depth map. It is above zero because not every depth pixel corresponds to
 * an image pixel.
 */
const NEAR = 2;

const indexOf = ({ column, row }: Pixel, width: number): number => row * width + column;
const pixelOf = (index: number, width: number): Pixel => ({ column: index % width, row: Math.floor(index / width) });

/** The image's pixel that corresponds to the given pixel of the depth map, or to the nearest one. */
function imageIndexOf(correspondence: Int32Array, { column, row }: Pixel, width: number): number {
  let [best, least] = [-1, NEAR * NEAR + 1];
  for (let index = 0; index < correspondence.length; index++) {
    const other = correspondence[index] ?? -1;
    if (other < 0) continue;
    const [across, down] = [(other % width) - column, Math.floor(other / width) - row];
    const squared = across * across + down * down;
    if (squared < least) [best, least] = [index, squared];
  }
  return best;
}

function indices({ image, depth, numbers }: Run, side: Side, pixel: Pixel): Record<Side, number> {
  const correspondence = numbers.of("correspondence");
  if (side === "image") {
    const index = indexOf(pixel, image.width);
    return { image: index, depth: correspondence[index] ?? -1 };
  }
  return { image: imageIndexOf(correspondence, pixel, depth.width), depth: indexOf(pixel, depth.width) };
}

/** Three numbers of a pixel, if they exist. */
function three(data: ArrayLike<number>, index: number, channels = 3): number[] | null {
  const found = [0, 1, 2].map((c) => data[channels * index + c] ?? NaN);
  return index >= 0 && found.every(Number.isFinite) ? found : null;
}

const one = (value: number | undefined): number[] => (value !== undefined && Number.isFinite(value) ? [value] : []);

/** Converts stored colours to shares of linear light. */
function coloursAt({ data, mask, transfer }: ColorImage, index: number): { stored: number[]; log: number[] } | null {
  const floats = data instanceof Float32Array;
  const stored = mask && !mask[index] ? null : three(data, index, floats ? 3 : 4);
  if (!stored) return null;
  const white = floats ? 1 : data instanceof Uint16Array ? 65535 : 255;
  const encoded = !floats && (transfer ?? (white === 255 ? "srgb" : "linear")) === "srgb";
  // IEC 61966-2-1.
  const linear = (share: number) =>
    !encoded ? share : share <= 0.04045 ? share / 12.92 : ((share + 0.055) / 1.055) ** 2.4;
  return { stored, log: stored.map((value) => Math.log(linear(value / white))) };
}

/** The number that is drawn for a pixel. */
function drawnAt(raster: Raster | undefined, pixel: Pixel | null): number | undefined {
  if (!raster || !pixel) return undefined;
  const { left, top, width, height, stride, data } = raster;
  const [column, row] = [Math.floor((pixel.column - left) / stride), Math.floor((pixel.row - top) / stride)];
  return column < 0 || row < 0 || column >= width || row >= height ? undefined : data[row * width + column];
}

const turned = (rotation: readonly number[], vector: readonly number[]): number[] =>
  [0, 3, 6].map((row) => vector.reduce((sum, value, c) => sum + (rotation[row + c] ?? NaN) * value, 0));

/** The point of a pixel: points are listed in the order of the pixels that have a depth. */
function pointOf(points: Float32Array, depth: Float32Array, index: number): number[] | null {
  const { places, count } = placesOf(depth);
  const place = places[index] ?? -1;
  return 3 * count === points.length && place >= 0 ? three(points, place) : null;
}

export function probe(run: Run, side: Side, pixel: Pixel): Probed {
  const { image, depth, numbers, estimator, painter } = run;
  const at = indices(run, side, pixel);
  const [mine, theirs] = [at.image, at.depth];
  const [albedo, shading] = [three(numbers.of("albedo"), mine), three(numbers.of("shading"), mine)];
  const depthNormal = three(numbers.of("depthNormals"), theirs);
  const colours = mine < 0 ? null : coloursAt(image, mine);
  const values: Probed["values"] = {};
  if (mine >= 0) {
    values.picture = colours?.stored ?? [];
    values.imageNormals = three(numbers.of("imageNormals"), mine) ?? [];
    values.imageDepth = one(numbers.of("imageDepth")[mine]);
    values.albedo = albedo?.map(Math.exp) ?? [];
    values.shading = shading?.map(Math.exp) ?? [];
    values.residual = one(numbers.of("residual")[mine]);
  }
  if (theirs >= 0) {
    values.given = one(depthAt(depth)(theirs));
    values.refinedDepth = one(numbers.of("refinedDepth")[theirs]);
    values.depthNormals = depthNormal ?? [];
  }
  const pixels = {
    image: mine < 0 ? null : pixelOf(mine, image.width),
    depth: theirs < 0 ? null : pixelOf(theirs, depth.width),
  };
  const { normalError, depthError, refinementError } = painter.errors;
  values.normalError = one(drawnAt(normalError, pixels.image));
  values.depthError = one(drawnAt(depthError, pixels.image));
  values.refinementError = one(drawnAt(refinementError, pixels.depth));
  return {
    pixels,
    points: {
      image: pointOf(numbers.points("image"), numbers.of("imageDepth"), mine),
      depth: pointOf(numbers.points("depth"), numbers.of("refinedDepth"), theirs),
    },
    values,
    log: colours?.log ?? null,
    predicted: albedo && shading ? albedo.map((value, c) => value + (shading[c] ?? NaN)) : null,
    prior: depthNormal && turned(estimator.report.pose.rotation, depthNormal),
  };
}
