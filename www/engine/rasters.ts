/** The library's arrays, cropped and subsampled to what a screen can show. Runs in the worker. */

import type { ColorImage, DepthMap } from "../../pkg/index.js";
import { quantile, someSorted } from "../draw/colours";
import type { Picture, Raster, Surface } from "./protocol";

/** Longest side of a drawn view in pixels, so that all canvases together are drawn within one frame. */
const LONGEST = 512;

/** Largest number of points of a drawn cloud. */
const MOST_POINTS = 20_000;

/** Margin around the object, pixels. */
const MARGIN = 2;

/** The part of a view that is drawn. */
export interface Cut {
  fullWidth: number;
  fullHeight: number;
  left: number;
  top: number;
  width: number;
  height: number;
}

/** The part of the view for which `inside` holds, or the whole view if it holds nowhere, so that a small object is drawn large. */
export function cutOf(width: number, height: number, inside: (index: number) => boolean): Cut {
  let [left, top, right, bottom] = [width, height, -1, -1];
  for (let row = 0, index = 0; row < height; row++) {
    for (let column = 0; column < width; column++, index++) {
      if (!inside(index)) continue;
      if (column < left) left = column;
      if (column > right) right = column;
      if (row < top) top = row;
      bottom = row;
    }
  }
  if (bottom < 0) return { fullWidth: width, fullHeight: height, left: 0, top: 0, width, height };
  left = Math.max(0, left - MARGIN);
  top = Math.max(0, top - MARGIN);
  right = Math.min(width - 1, right + MARGIN);
  bottom = Math.min(height - 1, bottom + MARGIN);
  return { fullWidth: width, fullHeight: height, left, top, width: right - left + 1, height: bottom - top + 1 };
}

const strideOf = ({ width, height }: Cut): number => Math.max(1, Math.ceil(Math.max(width, height) / LONGEST));

/** The grid of the drawn pixels, or of every `step`-th of them. */
export function gridOf(cut: Cut, step = 1): Pick<Raster, "left" | "top" | "width" | "height" | "stride"> {
  const stride = step * strideOf(cut);
  return {
    left: cut.left,
    top: cut.top,
    width: Math.ceil(cut.width / stride),
    height: Math.ceil(cut.height / stride),
    stride,
  };
}

/** `pick(index)` fills one pixel of `channels` numbers into `out` at `at`. */
function gather(
  cut: Cut,
  channels: 1 | 3,
  pick: (index: number, out: Float32Array, at: number) => void,
  step = 1,
): Raster {
  const grid = gridOf(cut, step);
  const { left, top, width, height, stride } = grid;
  const data = new Float32Array(width * height * channels);
  let at = 0;
  for (let row = 0; row < height; row++) {
    for (let column = 0; column < width; column++, at += channels) {
      pick((top + row * stride) * cut.fullWidth + left + column * stride, data, at);
    }
  }
  return { ...grid, channels, data };
}

/** One number for each drawn pixel. */
export const measured = (cut: Cut, measure: (index: number) => number): Raster =>
  gather(cut, 1, (index, out, at) => (out[at] = measure(index)));

/** A view of the library as it is drawn. */
export function raster(data: Float32Array, channels: 1 | 3, cut: Cut): Raster {
  const grid = gridOf(cut);
  if (grid.stride === 1) {
    const part = new Float32Array(grid.width * grid.height * channels);
    const along = grid.width * channels;
    for (let row = 0; row < grid.height; row++) {
      const from = channels * ((grid.top + row) * cut.fullWidth + grid.left);
      part.set(data.subarray(from, from + along), row * along);
    }
    return { ...grid, channels, data: part };
  }
  return gather(cut, channels, (index, out, at) => {
    for (let c = 0; c < channels; c++) out[at + c] = data[index * channels + c] ?? NaN;
  });
}

export function cutOfImage({ width, height, mask }: ColorImage): Cut {
  return cutOf(width, height, (index) => mask === undefined || mask[index] !== 0);
}

/** The input image in its stored numbers, NaN outside the mask. */
export function picture(image: ColorImage, cut: Cut): Picture {
  const { data, mask } = image;
  const channels = data instanceof Float32Array ? 3 : 4;
  const drawn = gather(cut, 3, (index, out, at) => {
    const inside = mask === undefined || mask[index] !== 0;
    for (let c = 0; c < 3; c++) out[at + c] = inside ? (data[index * channels + c] ?? NaN) : NaN;
  });
  const integers = data instanceof Uint16Array ? 65535 : 255;
  const white = data instanceof Float32Array ? brightest(drawn.data) : integers;
  const encoded =
    !(data instanceof Float32Array) && (image.transfer ?? (integers === 255 ? "srgb" : "linear")) === "srgb";
  return { ...drawn, white, encoded };
}

/** Smallest distance of white from the median log colour, so that a single albedo, zero everywhere, is drawn as middle grey. */
const LEAST_WHITE = Math.LN2;
/** Share of the numbers that are not brighter than white, so that outliers do not darken the rest. */
const UP_TO_WHITE = 0.99;

/** The white level of logarithms of colours. */
export function whiteOf({ data }: Raster): number {
  const sorted = someSorted(data);
  return Math.max(LEAST_WHITE + (quantile(sorted, 0.5) ?? 0), quantile(sorted, UP_TO_WHITE) ?? 0);
}

/** Depth at a pixel in the unit of its view; holes are NaN. */
export function depthAt({ data, points, mask, unit, camera }: DepthMap): (index: number) => number {
  const factor = unit ?? (camera !== undefined && data instanceof Uint16Array ? 0.001 : 1);
  return (index) => {
    const stored = points ? (points[3 * index + 2] ?? NaN) : (data?.[index] ?? NaN);
    const hole = !Number.isFinite(stored) || (!points && stored <= 0) || (mask !== undefined && mask[index] === 0);
    return hole ? NaN : stored * factor;
  };
}

/** The mask, because refinement fills holes within it; if there is no mask, the measured pixels. */
export function cutOfDepth(depth: DepthMap): Cut {
  const { width, height, mask } = depth;
  const at = depthAt(depth);
  return cutOf(width, height, (index) => (mask ? mask[index] !== 0 : !Number.isNaN(at(index))));
}

/** Every n-th point of a list. */
function thinned(points: Float32Array): Float32Array {
  const count = points.length / 3;
  const every = Math.ceil(count / MOST_POINTS);
  if (every <= 1) return points.slice();
  const kept = new Float32Array(3 * Math.ceil(count / every));
  for (let from = 0, to = 0; from < count; from += every, to++) {
    kept.set(points.subarray(3 * from, 3 * from + 3), 3 * to);
  }
  return kept;
}

/** The index of each pixel's point in the list of pixels with a depth; -1 for pixels without a depth. */
export function placesOf(depth: Float32Array): { places: Int32Array; count: number } {
  const places = new Int32Array(depth.length).fill(-1);
  let count = 0;
  for (let i = 0; i < depth.length; i++) {
    const value = depth[i] ?? NaN;
    if (value - value === 0) places[i] = count++;
  }
  return { places, count };
}

/** Assigns the points to the pixels with a depth, in their order. If the numbers differ, the points remain a list. */
export function surface(points: Float32Array, depth: Float32Array, cut: Cut): Omit<Surface, "colours"> {
  const { places, count } = placesOf(depth);
  if (3 * count !== points.length || count === 0)
    return { left: 0, top: 0, width: 0, height: 0, stride: 1, points: thinned(points) };
  const { width, height } = gridOf(cut);
  const step = Math.max(1, Math.ceil(Math.sqrt((width * height) / MOST_POINTS)));
  const {
    data,
    channels: _,
    ...grid
  } = gather(
    cut,
    3,
    (index, out, at) => {
      const from = 3 * (places[index] ?? -1);
      for (let c = 0; c < 3; c++) out[at + c] = from < 0 ? NaN : (points[from + c] ?? NaN);
    },
    step,
  );
  return { ...grid, points: data };
}

function brightest(values: Float32Array): number {
  let most = 0;
  for (const value of values) if (value > most) most = value;
  return most || 1;
}
