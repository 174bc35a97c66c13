/** Extrinsics in the common notations, and in words. P_colour = R P_depth + t, metres. */

import type { Pose } from "../../pkg/index.js";
import { decimals } from "../draw/numbers";

const DEGREE = Math.PI / 180;
const at = (values: ArrayLike<number>, index: number): number => values[index] ?? 0;

/** Angles of R = Rx Ry Rz, the package's convention. */
export function poseOf(rotation: readonly number[], translation: readonly number[]): Pose {
  const r = (row: number, column: number) => at(rotation, 3 * row + column);
  const angles = {
    alpha: Math.atan2(-r(1, 2), r(2, 2)) / DEGREE,
    beta: Math.asin(Math.max(-1, Math.min(1, r(0, 2)))) / DEGREE,
    gamma: Math.atan2(-r(0, 1), r(0, 0)) / DEGREE,
  };
  const matrix = [0, 1, 2].map((row) => [r(row, 0), r(row, 1), r(row, 2), at(translation, row)]);
  return {
    scale: 1,
    rotation: [...rotation],
    translation: [...translation],
    angles,
    matrix: [...matrix, [0, 0, 0, 1]],
  };
}

export const identity: Pose = poseOf([1, 0, 0, 0, 1, 0, 0, 0, 1], [0, 0, 0]);

/** The product of two rotations. */
export const times = (a: readonly number[], b: readonly number[]): number[] =>
  Array.from({ length: 9 }, (_, i) =>
    [0, 1, 2].reduce((sum, k) => sum + at(a, 3 * Math.floor(i / 3) + k) * at(b, 3 * k + (i % 3)), 0),
  );
const transposed = (a: readonly number[]): number[] =>
  Array.from({ length: 9 }, (_, i) => at(a, 3 * (i % 3) + Math.floor(i / 3)));
const turned = (a: readonly number[], v: readonly number[]): number[] =>
  [0, 1, 2].map((row) => [0, 1, 2].reduce((sum, k) => sum + at(a, 3 * row + k) * at(v, k), 0));

/** Whether a pose is that of a camera in the world, which does not relate two cameras. Open3D calls the depth camera's frame a world. */
export const isOfWorld = ({ to }: { to?: string }): boolean => to === "world";

/** The other direction. */
export function inverse({ rotation, translation }: Pose): Pose {
  const back = transposed(rotation);
  return poseOf(
    back,
    turned(back, translation).map((value) => -value),
  );
}

/** A unit quaternion's rotation, the real part last; nothing where its length is zero. */
export function fromQuaternion(x: number, y: number, z: number, w: number): number[] | undefined {
  const square = x * x + y * y + z * z + w * w;
  if (!(square > 0) || !Number.isFinite(square)) return undefined;
  const s = 2 / square;
  return [
    1 - s * (y * y + z * z),
    s * (x * y - z * w),
    s * (x * z + y * w),
    s * (x * y + z * w),
    1 - s * (x * x + z * z),
    s * (y * z - x * w),
    s * (x * z - y * w),
    s * (y * z + x * w),
    1 - s * (x * x + y * y),
  ];
}

export type EulerOrder = "rpy" | "xyz";

/** The rotation by degrees about x, y and z: one after the other about fixed axes (ROS), or R = Rx Ry Rz. */
export function fromEuler(x: number, y: number, z: number, order: EulerOrder): number[] {
  const turn = (axis: number, degrees: number): number[] => {
    const [c, s] = [Math.cos(degrees * DEGREE), Math.sin(degrees * DEGREE)];
    return axis === 0
      ? [1, 0, 0, 0, c, -s, 0, s, c]
      : axis === 1
        ? [c, 0, s, 0, 1, 0, -s, 0, c]
        : [c, -s, 0, s, c, 0, 0, 0, 1];
  };
  const [rx, ry, rz] = [turn(0, x), turn(1, y), turn(2, z)];
  return order === "rpy" ? times(rz, times(ry, rx)) : times(rx, times(ry, rz));
}

/** Twice the axis times the sine of the angle. */
const axisOf = (r: readonly number[]): number[] => [at(r, 7) - at(r, 5), at(r, 2) - at(r, 6), at(r, 3) - at(r, 1)];
const angleOf = (r: readonly number[]): number =>
  Math.atan2(Math.hypot(...axisOf(r)) / 2, (at(r, 0) + at(r, 4) + at(r, 8) - 1) / 2);

export const degreesOf = ({ rotation }: Pose): number => angleOf(rotation) / DEGREE;

/** Interpolates between two poses for the overlay's slider; only for display. */
export function between(a: Pose, b: Pose, share: number): Pose {
  if (share <= 0) return a;
  if (share >= 1) return b;
  const turn = times(b.rotation, transposed(a.rotation));
  const axis = axisOf(turn);
  const half = (angleOf(turn) * share) / 2;
  const length = Math.max(Math.hypot(...axis), Number.MIN_VALUE);
  const [x = 0, y = 0, z = 0] = axis.map((value) => (value / length) * Math.sin(half));
  const step = fromQuaternion(x, y, z, Math.cos(half));
  const rotation = step ? times(step, a.rotation) : a.rotation;
  return poseOf(
    rotation,
    a.translation.map((value, i) => value + share * (at(b.translation, i) - value)),
  );
}

/** Four rows in the form of a text file. */
export const matrixText = ({ rotation, translation }: Pose): string =>
  [0, 1, 2]
    .map((row) =>
      [...[0, 1, 2].map((column) => at(rotation, 3 * row + column)), at(translation, row)]
        .map((value) => decimals(value, 6).padStart(10))
        .join(" "),
    )
    .concat("  0.000000   0.000000   0.000000   1.000000")
    .join("\n");
