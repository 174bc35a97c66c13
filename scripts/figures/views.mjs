// Points, projections and borders in the orthographic views of a rendered pair.
import { turn } from "../../protocols/rotations.mjs";
import { indices, triple } from "./raster.mjs";

/** The point of a pixel in an orthographic view, in pixels, with the origin in the middle of the view. */
export const pointOf = ({ width, height }, depth, index) => [
  (index % width) - (width - 1) / 2,
  Math.floor(index / width) - (height - 1) / 2,
  depth[index],
];

export const moved = ({ scale, rotation, translation }, point) =>
  turn(rotation, point).map((value, axis) => scale * value + translation[axis]);

/** Column and row of a point's projection in the image. */
export const fallsOn = ({ width, height }, [x, y]) => [x + (width - 1) / 2, y + (height - 1) / 2];

/** The index of the pixel that a point projects to; -1 if it projects outside the raster. */
export function pixelAt(size, point) {
  const [column, row] = fallsOn(size, point).map(Math.round);
  return column >= 0 && row >= 0 && column < size.width && row < size.height ? row * size.width + column : -1;
}

/** Those of a pixel's four neighbours that are inside the raster, each with its direction. */
export function neighbours({ width, height }, index) {
  const [column, row] = [index % width, Math.floor(index / width)];
  const all = [
    [1, 0],
    [0, 1],
    [-1, 0],
    [0, -1],
  ];
  return all
    .filter(([u, v]) => column + u >= 0 && column + u < width && row + v >= 0 && row + v < height)
    .map(([u, v]) => ({ index: index + u + v * width, direction: [u, v] }));
}

/** The border between a pixel and a neighbour, as a line between two corners. */
export function sideOf({ width }, index, [u, v]) {
  const [x, y] = [(index % width) + 0.5 + u / 2, Math.floor(index / width) + 0.5 + v / 2];
  return [x - v / 2, y - u / 2, x + v / 2, y + u / 2];
}

/** Borders of pixels at depth discontinuities: in front of a farther surface (`ahead`) or next to a pixel without depth (`ofNothing`). */
export function jumps(size, depth, least) {
  const found = { ahead: [], ofNothing: [] };
  for (const index of indices(size, (index) => Number.isFinite(depth[index])))
    for (const { index: beside, direction } of neighbours(size, index)) {
      const step = depth[beside] - depth[index];
      if (step > least) found.ahead.push(sideOf(size, index, direction));
      else if (Number.isNaN(step)) found.ofNothing.push(sideOf(size, index, direction));
    }
  return found;
}

/** Normals of an orthographic depth map by central differences; NaN where a neighbour is missing. */
export function normalsOf(size, depth) {
  const normals = new Float32Array(3 * size.width * size.height).fill(NaN);
  for (const index of indices(size, (index) => Number.isFinite(depth[index]))) {
    const [p, q] = [1, size.width].map((step) => {
      const [before, behind] = [depth[index - step], depth[index + step]];
      return Number.isFinite(before) && Number.isFinite(behind) ? (behind - before) / 2 : NaN;
    });
    const length = Math.hypot(p, q, 1);
    normals.set([p / length, q / length, -1 / length], 3 * index);
  }
  return normals;
}

/** The share of light that a surface reflects under a lamp beside the camera. */
export const lit = (normals) => (index) => {
  const [x, y, z] = triple(normals, index);
  const light = -0.45 * x - 0.45 * y - 0.77 * z;
  return Number.isFinite(light) ? 0.04 + 0.86 * Math.max(0, light) : undefined;
};
