/** Copies of the library's arrays, cut and thinned to what a screen can show. Runs in the worker. */

import type { ColorImage, DepthMap } from "../../pkg/index.js";
import type { Picture, Raster, Surface } from "./protocol";

/** Longest side of a drawn view in pixels: all canvases together are painted within one frame. */
const LONGEST = 512;

/** Most points of a drawn cloud. */
const MOST_POINTS = 20_000;

/** Pixels of air around the object. */
const MARGIN = 2;

/** The part of a view that is drawn. */
export interface Cut {
  fullWidth: number;
  left: number;
  top: number;
  width: number;
  height: number;
}

/** The part in which `inside` holds; all of it where it never does. An object in a far corner is still seen large. */
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
  if (bottom < 0) return { fullWidth: width, left: 0, top: 0, width, height };
  left = Math.max(0, left - MARGIN);
  top = Math.max(0, top - MARGIN);
  right = Math.min(width - 1, right + MARGIN);
  bottom = Math.min(height - 1, bottom + MARGIN);
  return { fullWidth: width, left, top, width: right - left + 1, height: bottom - top + 1 };
}

const strideOf = ({ width, height }: Cut): number => Math.max(1, Math.ceil(Math.max(width, height) / LONGEST));

/** `pick(index)` fills one pixel of `channels` numbers into `out` at `at`. */
function gather(cut: Cut, channels: 1 | 3, pick: (index: number, out: Float32Array, at: number) => void): Raster {
  const { fullWidth, left, top, width, height } = cut;
  const stride = strideOf(cut);
  const columns = Math.ceil(width / stride);
  const rows = Math.ceil(height / stride);
  const data = new Float32Array(columns * rows * channels);
  let at = 0;
  for (let row = 0; row < rows; row++) {
    for (let column = 0; column < columns; column++, at += channels) {
      pick((top + row * stride) * fullWidth + left + column * stride, data, at);
    }
  }
  return { left, top, width: columns, height: rows, stride, channels, data };
}

/** A view of the library as it is drawn. */
export function raster(data: Float32Array, channels: 1 | 3, cut: Cut): Raster {
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
  const encoded = !(data instanceof Float32Array) && (image.transfer ?? (integers === 255 ? "srgb" : "linear")) === "srgb";
  return { ...drawn, white, encoded };
}

/** The least white level of log colours: those of one paint, zero everywhere, are a middle grey. */
const LEAST_WHITE = 2;
/** Share of the numbers that are no brighter than white: single ones must not darken everything else. */
const UP_TO_WHITE = 0.99;

/** Logarithms of colours as colours. */
export function fromLog(log: Float32Array, cut: Cut): Picture {
  const drawn = gather(cut, 3, (index, out, at) => {
    for (let c = 0; c < 3; c++) out[at + c] = Math.exp(log[index * 3 + c] ?? NaN);
  });
  const sorted = drawn.data.filter(Number.isFinite).sort();
  const white = Math.max(LEAST_WHITE * (sorted[Math.floor(0.5 * sorted.length)] ?? 0), sorted[Math.floor(UP_TO_WHITE * (sorted.length - 1))] ?? 0);
  return { ...drawn, white: white || 1, encoded: false };
}

/** Depth at a pixel in the unit of its view; holes are NaN. */
function depthAt({ data, points, mask, unit, camera }: DepthMap): (index: number) => number {
  const factor = unit ?? (camera !== undefined && data instanceof Uint16Array ? 0.001 : 1);
  return (index) => {
    const stored = points ? (points[3 * index + 2] ?? NaN) : (data?.[index] ?? NaN);
    const hole = !Number.isFinite(stored) || (!points && stored <= 0) || (mask !== undefined && mask[index] === 0);
    return hole ? NaN : stored * factor;
  };
}

/** The mask, because refinement fills holes within it; where there is none, what was measured. */
export function cutOfDepth(depth: DepthMap): Cut {
  const { width, height, mask } = depth;
  const at = depthAt(depth);
  return cutOf(width, height, (index) => (mask ? mask[index] !== 0 : !Number.isNaN(at(index))));
}

export function givenDepth(depth: DepthMap, cut: Cut): Raster {
  const at = depthAt(depth);
  return gather(cut, 1, (index, out, to) => (out[to] = at(index)));
}

/** Every n-th point of a list. */
function thinned(points: Float32Array): Float32Array {
  const count = points.length / 3;
  const every = Math.ceil(count / MOST_POINTS);
  if (every <= 1) return points;
  const kept = new Float32Array(3 * Math.ceil(count / every));
  for (let from = 0, to = 0; from < count; from += every, to++) {
    kept.set(points.subarray(3 * from, 3 * from + 3), 3 * to);
  }
  return kept;
}

/** The points back at the pixels that they come from: those with a depth, in their order. Where these are others, a list. */
export function surface(points: Float32Array, depth: Float32Array, cut: Cut): Surface {
  const place = new Int32Array(depth.length).fill(-1);
  let count = 0;
  for (let i = 0; i < depth.length; i++) if (Number.isFinite(depth[i])) place[i] = count++;
  if (3 * count !== points.length || count === 0) return { width: 0, height: 0, step: 1, points: thinned(points) };
  const stride = strideOf(cut);
  const step = Math.ceil(Math.sqrt((cut.width * cut.height) / stride ** 2 / MOST_POINTS));
  const grid = gather(cut, 3, (index, out, at) => {
    const from = place[index] ?? -1;
    for (let c = 0; c < 3; c++) out[at + c] = from < 0 ? NaN : (points[3 * from + c] ?? NaN);
  });
  if (step <= 1) return { width: grid.width, height: grid.height, step: 1, points: grid.data };
  const [width, height] = [Math.ceil(grid.width / step), Math.ceil(grid.height / step)];
  const kept = new Float32Array(3 * width * height);
  for (let to = 0; to < width * height; to++) {
    const from = Math.floor(to / width) * step * grid.width + (to % width) * step;
    kept.set(grid.data.subarray(3 * from, 3 * from + 3), 3 * to);
  }
  return { width, height, step, points: kept };
}

function brightest(values: Float32Array): number {
  let most = 0;
  for (const value of values) if (value > most) most = value;
  return most || 1;
}
