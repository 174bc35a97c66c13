/**
 * The axes of a range image in the frame of its cloud: right, forward and up, as an observer at the cloud's origin sees them.
 *
 * A spinning scanner turns about `up`. Columns count azimuths from `forward` to the right, and rows count elevations downwards, so that a range
 * image has the handedness of a picture.
 */
import { rangeOf } from "./scan.js";

export const DEGREE = Math.PI / 180;
export const TURN = 2 * Math.PI;

export type Vector = [number, number, number];

export interface Frame {
  right: Vector;
  forward: Vector;
  up: Vector;
}

export const dot = (a: Vector, b: Vector): number => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const cross = (a: Vector, b: Vector): Vector => [
  a[1] * b[2] - a[2] * b[1],
  a[2] * b[0] - a[0] * b[2],
  a[0] * b[1] - a[1] * b[0],
];
export function unit(vector: Vector): Vector {
  const length = Math.hypot(...vector) || 1;
  return [vector[0] / length, vector[1] / length, vector[2] / length];
}

const X: Vector = [1, 0, 0];
const Y_UP: Vector = [0, -1, 0];
const Z: Vector = [0, 0, 1];

/** Axes with the given up direction, and with the forward direction that is perpendicular to it and nearest to the given one. */
export function frameOf(up: Vector, forward: Vector): Frame {
  const right = cross(forward, up);
  // A forward direction that is parallel to up does not determine the azimuth.
  const side = unit(Math.hypot(...right) > 1e-3 ? right : cross(Math.abs(up[0]) < 0.9 ? X : Z, up));
  return { right: side, forward: cross(up, side), up };
}

/** Axes that a scanner may turn about: z of a vehicle's frame, y of an optical frame, and x. Their signs only turn the range image. */
export const AXES: readonly Vector[] = [Z, Y_UP, X];

/** The up direction for an observer who looks along `forward`: z, or y of an optical frame where z itself is forward. */
export const upright = (forward: Vector): Vector => (Math.abs(forward[2]) > Math.SQRT1_2 ? Y_UP : Z);

/** The mean direction of all valid points. Its length measures how narrow the field of view is: 1 for a single ray, 0 for all around. */
export function meanDirection(points: Float32Array): Vector {
  let [count, x, y, z] = [0, 0, 0, 0];
  for (let at = 0; at < points.length; at += 3) {
    const range = rangeOf(points, at);
    if (!(range > 0 && range < Infinity)) continue;
    count++;
    x += (points[at] ?? 0) / range;
    y += (points[at + 1] ?? 0) / range;
    z += (points[at + 2] ?? 0) / range;
  }
  return count === 0 ? [0, 0, 0] : [x / count, y / count, z / count];
}

/** Length of the mean direction below which a scanner looks all around. The check has the same rule in src/calibration/ahead.rs. */
const ALL_AROUND = 0.5;

/** Whether points with this mean direction have a field of view that faces one way. */
export const facesOneWay = (mean: Vector): boolean => Math.hypot(...mean) > ALL_AROUND;

/** Cylindrical coordinates of the points about the up axis. */
export interface Polar {
  frame: Frame;
  /** Azimuth from forward to the right, -pi to pi, radians. */
  azimuth: Float64Array;
  /** Distance from the axis, metres. */
  radius: Float64Array;
  /** Height along the axis, metres. */
  height: Float64Array;
}

export function polarOf(points: Float32Array, frame: Frame): Polar {
  const count = points.length / 3;
  const polar = {
    frame,
    azimuth: new Float64Array(count),
    radius: new Float64Array(count),
    height: new Float64Array(count),
  };
  const { right, forward, up } = frame;
  for (let index = 0; index < count; index++) {
    const [x, y, z] = [points[3 * index] ?? 0, points[3 * index + 1] ?? 0, points[3 * index + 2] ?? 0];
    const across = x * right[0] + y * right[1] + z * right[2];
    const along = x * forward[0] + y * forward[1] + z * forward[2];
    polar.azimuth[index] = Math.atan2(across, along);
    polar.radius[index] = Math.sqrt(across * across + along * along);
    polar.height[index] = x * up[0] + y * up[1] + z * up[2];
  }
  return polar;
}

/** The axis along which unit directions scatter least within their groups, pooled over all groups, and the scatter along any axis. */
export function leastScatter(
  points: Float32Array,
  group: ArrayLike<number>,
): { axis: Vector; along: (axis: Vector) => number } {
  const sums = new Map<number, number[]>();
  const directions = new Float64Array(points.length);
  for (let at = 0; at < points.length; at += 3) {
    const range = rangeOf(points, at);
    for (let axis = 0; axis < 3; axis++) directions[at + axis] = (points[at + axis] ?? 0) / range;
    const key = group[at / 3] ?? 0;
    const sum = sums.get(key) ?? [0, 0, 0, 0];
    for (let axis = 0; axis < 3; axis++) sum[axis] = (sum[axis] ?? 0) + (directions[at + axis] ?? 0);
    sum[3] = (sum[3] ?? 0) + 1;
    sums.set(key, sum);
  }
  const scatter = new Float64Array(9);
  for (let at = 0; at < points.length; at += 3) {
    const sum = sums.get(group[at / 3] ?? 0) ?? [];
    const off = [0, 1, 2].map((axis) => (directions[at + axis] ?? 0) - (sum[axis] ?? 0) / (sum[3] ?? 1));
    for (let entry = 0; entry < 9; entry++)
      scatter[entry] =
        (scatter[entry] ?? 0) + ((off[Math.floor(entry / 3)] ?? 0) * (off[entry % 3] ?? 0) * 3) / points.length;
  }
  const along = (axis: Vector): number => dot(axis, times(scatter, axis));
  return { axis: smallest(scatter), along };
}

const times = (m: ArrayLike<number>, v: Vector): Vector => [
  (m[0] ?? 0) * v[0] + (m[1] ?? 0) * v[1] + (m[2] ?? 0) * v[2],
  (m[3] ?? 0) * v[0] + (m[4] ?? 0) * v[1] + (m[5] ?? 0) * v[2],
  (m[6] ?? 0) * v[0] + (m[7] ?? 0) * v[1] + (m[8] ?? 0) * v[2],
];

/** Rounds of inverse iteration; the error of each shrinks by the ratio of the two smallest eigenvalues. */
const ROUNDS = 30;

/** Eigenvector of the smallest eigenvalue of a symmetric positive matrix, by inverse iteration with its adjugate, the inverse up to scale. */
function smallest(m: ArrayLike<number>): Vector {
  const [a, b, c] = [0, 3, 6].map((row): Vector => [m[row] ?? 0, m[row + 1] ?? 0, m[row + 2] ?? 0]) as [
    Vector,
    Vector,
    Vector,
  ];
  const adjugate = [cross(b, c), cross(c, a), cross(a, b)].flat();
  let axis: Vector = unit([0.1, 0.2, 1]);
  for (let round = 0; round < ROUNDS; round++) {
    const next = times(adjugate, axis);
    if (!(Math.hypot(...next) > 0)) return axis;
    axis = unit(next);
  }
  return axis;
}
