// Views of meshes by pinhole cameras. Plain numbers, metres and pixels.
import { turn } from "./rotations.mjs";

const cross = ([a, b, c], [d, e, f]) => [b * f - c * e, c * d - a * f, a * e - b * d];
const minus = (a, b) => a.map((value, axis) => value - b[axis]);
const plus = (a, b) => a.map((value, axis) => value + b[axis]);
export const times = (a, factor) => a.map((value) => value * factor);
const unit = (a) => times(a, 1 / Math.hypot(...a));

/** A point transformed by a pose. */
export const moved = ({ rotation, translation }, point) => plus(turn(rotation, point), translation);

/** The point at a depth on a pixel's ray. */
export const pointAt = ({ fx, fy, cx, cy }, [column, row], z) => [((column - cx) * z) / fx, ((row - cy) * z) / fy, z];

/** The mean of a depth map's points. */
export function middleOf({ width, data, camera, unit: length = 1, mask }) {
  let [sum, count] = [[0, 0, 0], 0];
  for (const [index, value] of data.entries()) {
    if (!(value > 0) || (mask && !mask[index])) continue;
    sum = plus(sum, pointAt(camera, [index % width, Math.floor(index / width)], value * length));
    count++;
  }
  return times(sum, 1 / count);
}

/** The mesh of a raster of points (null where missing): two triangles a cell, none across a jump along z. */
export function meshOf(width, points, jump) {
  const triangles = [];
  const add = (...corners) => {
    const depths = corners.map((corner) => points[corner]?.[2] ?? NaN);
    if (Math.max(...depths) - Math.min(...depths) <= jump) triangles.push(corners);
  };
  for (let index = 0; index + width < points.length; index++) {
    if (index % width === width - 1) continue;
    add(index, index + 1, index + width);
    add(index + 1, index + width + 1, index + width);
  }
  const normals = points.map(() => [0, 0, 0]);
  for (const corners of triangles) {
    const [a, b, c] = corners.map((corner) => points[corner]);
    // By the winding, the normal points towards the raster's camera. Its length is twice the area.
    const normal = cross(minus(c, a), minus(b, a));
    for (const corner of corners) normals[corner] = plus(normals[corner], normal);
  }
  return { points, normals, triangles };
}

/** Depth (NaN where nothing is seen) and unit normals, by a z-buffer, with perspective-correct interpolation. */
export function seen({ points, normals, triangles }, { fx, fy, cx, cy }, { width, height }, pose) {
  const placed = points.map((point) => point && moved(pose, point));
  const turned = normals.map((normal) => turn(pose.rotation, normal));
  const pixels = placed.map((point) => point && [(fx * point[0]) / point[2] + cx, (fy * point[1]) / point[2] + cy]);
  const [depth, seenNormals] = [new Float32Array(width * height).fill(NaN), new Float32Array(3 * width * height)];
  const span = (values, most) => [
    Math.max(0, Math.ceil(Math.min(...values))),
    Math.min(most - 1, Math.floor(Math.max(...values))),
  ];
  for (const corners of triangles) {
    const [a, b, c] = corners.map((corner) => pixels[corner]);
    const area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    if (Math.abs(area) < 1e-9) continue;
    const [left, right] = span([a[0], b[0], c[0]], width);
    const [top, low] = span([a[1], b[1], c[1]], height);
    for (let v = top; v <= low; v++) {
      for (let u = left; u <= right; u++) {
        const first = ((b[0] - u) * (c[1] - v) - (b[1] - v) * (c[0] - u)) / area;
        const second = ((c[0] - u) * (a[1] - v) - (c[1] - v) * (a[0] - u)) / area;
        const shares = [first, second, 1 - first - second];
        if (Math.min(...shares) < -1e-9) continue;
        const weights = shares.map((share, k) => share / placed[corners[k]][2]);
        const z = 1 / (weights[0] + weights[1] + weights[2]);
        const at = v * width + u;
        if (depth[at] <= z) continue;
        depth[at] = z;
        const normal = corners.reduce(
          (sum, corner, k) => plus(sum, times(unit(turned[corner]), weights[k])),
          [0, 0, 0],
        );
        seenNormals.set(unit(normal), 3 * at);
      }
    }
  }
  return { depth, normals: seenNormals };
}

/** log S of three channels under 27 coefficients (Eq. 3). */
export function shade(light, [x, y, z]) {
  const [c1, c2, c3, c4, c5] = [0.429043, 0.511664, 0.743125, 0.886227, 0.247708];
  const basis = [
    ...[c4, 2 * c2 * y, 2 * c2 * z, 2 * c2 * x, 2 * c1 * x * y, 2 * c1 * y * z],
    ...[c3 * z * z - c5, 2 * c1 * x * z, c1 * (x * x - y * y)],
  ];
  return [0, 1, 2].map((channel) => basis.reduce((sum, value, k) => sum + value * light[9 * channel + k], 0));
}
