/** A coarse description of a moment, enough to detect whether the rig or the scene has moved between two moments. */
import type { CheckFrame } from "../types.js";

/** Cells of the grid on which images are averaged. */
const [COLUMNS, ROWS] = [16, 12];
/** Pixels sampled along each side of a cell. */
const SAMPLES = 6;

export interface Signature {
  /** Brightness of each cell relative to the brightest, 0 to 1. */
  light: Float32Array;
  /** Mean depth of each cell, metres; NaN for an empty cell. */
  depth: Float32Array;
  /** Share of cells with a depth. */
  valid: number;
}

/** Means over a grid of the values of `at` at sampled pixels, without those that are NaN. */
function gridOf(width: number, height: number, at: (pixel: number) => number): Float32Array {
  const found = new Float32Array(COLUMNS * ROWS);
  for (let row = 0; row < ROWS; row++)
    for (let column = 0; column < COLUMNS; column++) {
      let [sum, count] = [0, 0];
      for (let i = 0; i < SAMPLES; i++)
        for (let j = 0; j < SAMPLES; j++) {
          const x = Math.floor(((column + (j + 0.5) / SAMPLES) * width) / COLUMNS);
          const y = Math.floor(((row + (i + 0.5) / SAMPLES) * height) / ROWS);
          const value = at(y * width + x);
          if (Number.isNaN(value)) continue;
          sum += value;
          count++;
        }
      found[row * COLUMNS + column] = count === 0 ? NaN : sum / count;
    }
  return found;
}

/** The brightness of each cell relative to the brightest. */
export function lightOf({ width, height, data }: CheckFrame["image"]): Float32Array {
  const channels = data instanceof Float32Array ? 3 : 4;
  const grid = gridOf(width, height, (pixel) => {
    const at = pixel * channels;
    return (data[at] ?? 0) + 2 * (data[at + 1] ?? 0) + (data[at + 2] ?? 0);
  });
  const most = grid.reduce((a, b) => Math.max(a, b), 0);
  return most > 0 ? grid.map((value) => value / most) : grid;
}

function depthOf({ width, height, data, points, unit = 1 }: CheckFrame["depth"]): Float32Array {
  return gridOf(width, height, (pixel) => {
    const value = points ? (points[3 * pixel + 2] ?? NaN) : (data?.[pixel] ?? NaN) * unit;
    return value > 0 && value < 1e6 ? value : NaN;
  });
}

export function signatureOf(image: CheckFrame["image"], depth: CheckFrame["depth"]): Signature {
  const grid = depthOf(depth);
  const valid = grid.reduce((sum, value) => sum + (Number.isNaN(value) ? 0 : 1), 0) / grid.length;
  return { light: lightOf(image), depth: grid, valid };
}

/** The mean change of a cell: the change of brightness plus that of depth relative to the larger depth. */
export function differenceOf(a: Signature, b: Signature): number {
  let [depth, both] = [0, 0];
  for (let cell = 0; cell < a.depth.length; cell++) {
    const [near, far] = [a.depth[cell] ?? NaN, b.depth[cell] ?? NaN];
    if (Number.isNaN(near) || Number.isNaN(far)) continue;
    depth += Math.abs(near - far) / Math.max(near, far);
    both++;
  }
  return changeOf(a.light, b.light) + (both === 0 ? 0 : depth / both);
}

/** The mean change of a cell's brightness. */
export const changeOf = (a: Float32Array, b: Float32Array): number =>
  a.reduce((sum, value, cell) => sum + Math.abs(value - (b[cell] ?? 0)), 0) / a.length;

/** Largest difference that counts as noise; the noise of a camera on a table is a few thousandths. */
export const ALIKE = 0.02;

/**
 * Indices of at most this many signatures that differ most from each other, beginning with the fullest depth map. Similar signatures are
 * taken once, since two images of one view carry no more information than one.
 */
export function different(all: readonly Signature[], most: number): number[] {
  const [first] = all.map((_, index) => index).sort((a, b) => (all[b]?.valid ?? 0) - (all[a]?.valid ?? 0));
  if (first === undefined) return [];
  const taken = [first];
  while (taken.length < most) {
    let [best, farthest] = [-1, ALIKE];
    all.forEach((signature, index) => {
      const distance = Math.min(...taken.map((other) => differenceOf(signature, all[other] ?? signature)));
      if (distance > farthest) [best, farthest] = [index, distance];
    });
    if (best < 0) break;
    taken.push(best);
  }
  return taken.sort((a, b) => a - b);
}
