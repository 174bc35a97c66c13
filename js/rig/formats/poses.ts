/**
 * Rigid motions as files write them, P_to = R P_from + t, checked, made exactly orthonormal and converted to metres.
 */
import { badFile } from "../../errors.js";
import { anglesOf, determinant, matrixOf } from "../../matrices.js";
import type { NamedPose, Pose } from "../types.js";
import type { Numbers } from "./numbers.js";
import { type ReaderWarning, warning } from "../warnings.js";

/** Largest element of R R^T - 1 of a rotation matrix. Rounded digits or a drifted calibration cause smaller ones. */
const ROTATION_TOLERANCE = 1e-2;
/** Elements below this need no warning: 0.06 degrees, the rounding of four digits. */
const ROUNDING = 1e-3;
/** Longest translation between the cameras of a rig, metres; a longer one is in millimetres. */
const LONGEST = 10;
/** Longest translation between the cameras of one device, metres. It is generous, as a vehicle's LiDAR may be called a depth camera. */
const APART = 3;

const at = (values: Numbers, index: number): number => values[index] ?? 0;

/** The largest element of R R^T - 1. */
function skewness(r: Numbers): number {
  let most = 0;
  for (let i = 0; i < 3; i++) {
    for (let j = 0; j < 3; j++) {
      const product =
        at(r, 3 * i) * at(r, 3 * j) + at(r, 3 * i + 1) * at(r, 3 * j + 1) + at(r, 3 * i + 2) * at(r, 3 * j + 2);
      most = Math.max(most, Math.abs(product - (i === j ? 1 : 0)));
    }
  }
  return most;
}

/** The nearest rotation, by Newton's iteration for the polar factor: convergence is quadratic, and four steps from 1e-2 are exact. */
function nearestRotation(matrix: Numbers): Numbers {
  let r = matrix;
  for (let step = 0; step < 6; step++) {
    const det = determinant(r);
    const cofactor = (a: number, b: number, c: number, d: number) => (at(r, a) * at(r, d) - at(r, b) * at(r, c)) / det;
    const inverse = [
      ...[cofactor(4, 5, 7, 8), -cofactor(3, 5, 6, 8), cofactor(3, 4, 6, 7)],
      ...[-cofactor(1, 2, 7, 8), cofactor(0, 2, 6, 8), -cofactor(0, 1, 6, 7)],
      ...[cofactor(1, 2, 4, 5), -cofactor(0, 2, 3, 5), cofactor(0, 1, 3, 4)],
    ];
    r = r.map((value, index) => (value + at(inverse, index)) / 2);
  }
  return r;
}

/** Whether nine numbers are a rotation, within the precision of the file's digits. */
export const isRotation = (values: Numbers): boolean => values.length === 9 && skewness(values) <= ROTATION_TOLERANCE;

/** The angle of a rotation, degrees. */
export const degreesOf = (r: Numbers): number =>
  (180 / Math.PI) * Math.acos(Math.min(1, Math.max(-1, (at(r, 0) + at(r, 4) + at(r, 8) - 1) / 2)));

/** Nine numbers as a rotation, with a warning if they had to be adjusted. */
export function rotationOf(values: Numbers, warnings: ReaderWarning[]): Numbers {
  if (values.length !== 9 || !values.every(Number.isFinite)) throw badFile("a rotation has nine numbers");
  const off = skewness(values);
  if (!(off <= ROTATION_TOLERANCE))
    throw badFile(`its matrix is not a rotation: R R^T differs from 1 by ${off.toPrecision(2)}`);
  if (determinant(values) < 0)
    throw badFile("its rotation mirrors (the determinant is -1): an axis or the handedness is swapped");
  if (off > ROUNDING)
    warnings.push(
      warning(
        "rotation-adjusted",
        `The rotation matrix is not quite orthonormal (R R^T differs from 1 by ${off.toPrecision(2)}); the nearest rotation is used.`,
        { off },
      ),
    );
  return nearestRotation(values);
}

/** The rotation of a quaternion x, y, z, w. */
export function ofQuaternion([x = 0, y = 0, z = 0, w = 0]: Numbers, warnings: ReaderWarning[]): Numbers {
  const length = Math.hypot(x, y, z, w);
  if (!(Math.abs(length - 1) <= ROTATION_TOLERANCE))
    throw badFile(`its quaternion has the length ${length.toPrecision(3)}, not 1`);
  if (Math.abs(length - 1) > ROUNDING)
    warnings.push(
      warning("quaternion-normalised", `The quaternion has length ${length.toPrecision(4)} and was normalised.`, {
        length,
      }),
    );
  const [a, b, c, d] = [x / length, y / length, z / length, w / length];
  return [
    ...[1 - 2 * (b * b + c * c), 2 * (a * b - c * d), 2 * (a * c + b * d)],
    ...[2 * (a * b + c * d), 1 - 2 * (a * a + c * c), 2 * (b * c - a * d)],
    ...[2 * (a * c - b * d), 2 * (b * c + a * d), 1 - 2 * (a * a + b * b)],
  ];
}

/** The rotation of a quaternion w, x, y, z. */
export const ofScalarFirst = ([w = NaN, x = NaN, y = NaN, z = NaN]: Numbers, warnings: ReaderWarning[]): Numbers =>
  ofQuaternion([x, y, z, w], warnings);

/** The rotation of a rotation vector in rad. */
export function ofVector([x = 0, y = 0, z = 0]: Numbers): Numbers {
  const angle = Math.hypot(x, y, z);
  if (angle < 1e-12) return [1, -z, y, z, 1, -x, -y, x, 1];
  const half = Math.sin(angle / 2) / angle;
  return ofQuaternion([x * half, y * half, z * half, Math.cos(angle / 2)], []);
}

/** ROS 1's yaw, pitch and roll in rad: rotations about the fixed axes in the order roll (x), pitch (y), yaw (z). */
export function ofYawPitchRoll([yaw = 0, pitch = 0, roll = 0]: Numbers): Numbers {
  const [cy, sy, cp, sp, cr, sr] = [
    Math.cos(yaw),
    Math.sin(yaw),
    Math.cos(pitch),
    Math.sin(pitch),
    Math.cos(roll),
    Math.sin(roll),
  ];
  return [
    cy * cp,
    cy * sp * sr - sy * cr,
    cy * sp * cr + sy * sr,
    sy * cp,
    sy * sp * sr + cy * cr,
    sy * sp * cr - cy * sr,
    -sp,
    cp * sr,
    cp * cr,
  ];
}

export const poseOf = (rotation: Numbers, translation: Numbers): Pose => ({
  scale: 1,
  rotation,
  translation,
  angles: anglesOf(rotation),
  matrix: matrixOf({ scale: 1, rotation, translation }),
});

export const identity = (): Pose => poseOf([1, 0, 0, 0, 1, 0, 0, 0, 1], [0, 0, 0]);

/** The rotation and the translation of a 3x4 or 4x4 matrix, row by row. */
export const parted = (m: Numbers): [rotation: Numbers, translation: Numbers] => [
  [0, 1, 2, 4, 5, 6, 8, 9, 10].map((index) => m[index] ?? NaN),
  [3, 7, 11].map((index) => m[index] ?? NaN),
];

/** The pose of a 3x4 or 4x4 matrix in metres; it throws where the matrix has no rotation. */
export function poseOfMatrix(m: Numbers): Pose {
  const [rotation, translation] = parted(m);
  return poseOf(rotationOf(rotation, []), translation);
}

/** The inverse motion. */
export function inverseOf({ rotation: r, translation: t }: Pose): Pose {
  const back = [0, 3, 6, 1, 4, 7, 2, 5, 8].map((index) => at(r, index));
  return poseOf(
    back,
    [0, 1, 2].map(
      (i) => -(at(back, 3 * i) * at(t, 0) + at(back, 3 * i + 1) * at(t, 1) + at(back, 3 * i + 2) * at(t, 2)),
    ),
  );
}

/** The motion that applies `b` first, then `a`. */
export function chained(a: Pose, b: Pose): Pose {
  const rotation = Array.from({ length: 9 }, (_, index) => {
    const [i, j] = [Math.floor(index / 3), index % 3];
    return (
      at(a.rotation, 3 * i) * at(b.rotation, j) +
      at(a.rotation, 3 * i + 1) * at(b.rotation, 3 + j) +
      at(a.rotation, 3 * i + 2) * at(b.rotation, 6 + j)
    );
  });
  const turned = [0, 1, 2].map(
    (i) =>
      at(a.rotation, 3 * i) * at(b.translation, 0) +
      at(a.rotation, 3 * i + 1) * at(b.translation, 1) +
      at(a.rotation, 3 * i + 2) * at(b.translation, 2),
  );
  return poseOf(
    rotation,
    turned.map((value, i) => value + at(a.translation, i)),
  );
}

/** A translation in metres. With `isRig` it relates two cameras and is read as millimetres if it is too long for a rig in metres. */
function shiftOf(values: Numbers, isRig: boolean, warnings: ReaderWarning[]): Numbers {
  if (values.length !== 3 || !values.every((value) => Number.isFinite(value) && Math.abs(value) < 1e9))
    throw badFile("a translation has three numbers");
  const length = Math.hypot(...values);
  if (!isRig || length <= LONGEST) return values.slice();
  warnings.push(
    warning(
      "translation-unit-guessed",
      `The translation is ${length.toPrecision(4)} units long and was guessed to be in millimetres.`,
      { length },
    ),
  );
  return values.map((value) => value / 1000);
}

/** A pose from a rotation and a translation that were read, with its names. */
export function motion(
  rotation: Numbers,
  translation: Numbers,
  names: Omit<NamedPose, "pose">,
  warnings: ReaderWarning[],
  isRig = true,
): NamedPose {
  const shift = isRig ? ofOneDevice(translation, names, warnings) : translation;
  return { ...names, pose: poseOf(rotationOf(rotation, warnings), shiftOf(shift, isRig, warnings)) };
}

const DEVICE = /depth|colou?r|rgb|\bir\b|infra|tof/i;

/** The depth camera and the colour camera of one device are centimetres apart, so a translation of several units is in centimetres. */
function ofOneDevice(values: Numbers, { from, to }: Omit<NamedPose, "pose">, warnings: ReaderWarning[]): Numbers {
  const length = Math.hypot(...values);
  const isDevice = DEVICE.test(from ?? "") && DEVICE.test(to ?? "");
  if (!isDevice || !(length > APART && length <= LONGEST)) return values;
  warnings.push(
    warning(
      "translation-unit-guessed",
      `The translation is ${length.toPrecision(4)} units long and was guessed to be in centimetres, because the cameras of one device are not metres apart.`,
      { length },
    ),
  );
  return values.map((value) => value / 100);
}

/** Whether a row is the last one of a motion's matrix, 0 0 0 1. */
export const isLastRow = (row: Numbers): boolean =>
  row.length === 4 && row.every((value, index) => Math.abs(value - (index === 3 ? 1 : 0)) < 1e-6);

/** A pose from 12 or 16 numbers, row by row. */
export function motionOfMatrix(
  values: Numbers,
  names: Omit<NamedPose, "pose">,
  warnings: ReaderWarning[],
  isRig = true,
): NamedPose {
  if (values.length !== 12 && values.length !== 16)
    throw badFile(`a transform has 3x4 or 4x4 numbers, not ${values.length}`);
  if (values.length === 16 && !isLastRow(values.slice(12))) {
    const last = [3, 7, 11, 15].map((index) => at(values, index));
    if (isLastRow(last)) throw badFile("its matrix is transposed: the translation is in the last row");
    throw badFile(`its matrix ends in the row ${values.slice(12).join(" ")}, not in 0 0 0 1`);
  }
  return motion(...parted(values), names, warnings, isRig);
}

/** Whether a pose is for points in a LiDAR's axes: two cameras that see the same scene look nearly along the same axis z. */
export const isOfScan = ({ rotation }: { readonly rotation: ArrayLike<number> }): boolean =>
  (rotation[8] ?? 1) < Math.SQRT1_2;

/** Numbers of a pose that differ less from those of the identity are rounding errors. */
const STILL = 1e-6;

/** Whether a pose is not the identity. */
export const isMoved = ({ rotation: r, translation: t }: Pose): boolean =>
  Math.hypot(...t, (r[0] ?? 0) - 1, (r[4] ?? 0) - 1, (r[8] ?? 0) - 1) > STILL;
