/**
 * Converts poses as 4x4 matrices and cameras as 3x3 matrices, as most programs store them, into the members that the numerics read. The
 * code that checks all poses and cameras checks whether a rotation is orthonormal and a focal length is above zero.
 */
import { isObject, wrong } from "./check.js";
import { BimodalError, refused } from "./errors.js";
import type { Matrix3, Matrix4, Pose } from "./types/index.js";

/** The members that a matrix stands for. */
export type PoseMembers = Pick<Pose, "scale" | "rotation" | "translation">;
export interface CameraMembers {
  fx: number;
  fy: number;
  cx: number;
  cy: number;
}

type Numbers = readonly number[];

const at = (values: Numbers, index: number): number => values[index] ?? NaN;

const isMatrix = (value: unknown): value is Matrix3 | Matrix4 => Array.isArray(value) || ArrayBuffer.isView(value);

/** Largest deviation of a factor of one in a matrix that was stored in single precision. */
const ROUNDING = 1e-6;
const near = (value: number, expected: number): boolean => Math.abs(value - expected) <= ROUNDING;

const range = (field: string, words: string, value?: number, index?: number): BimodalError =>
  new BimodalError("range", `${field}: ${words}`, field, refused(value, index));

/** The entries row by row, all of them finite numbers. */
function entries(matrix: Matrix3 | Matrix4, side: 3 | 4, field: string): number[] {
  const list: unknown[] = Array.from(matrix as ArrayLike<unknown>);
  const isNested = list.some(isMatrix);
  const rows = isNested ? list.map((row) => (isMatrix(row) ? Array.from(row as ArrayLike<unknown>) : [row])) : [list];
  const isWhole = isNested
    ? rows.length === side && rows.every(({ length }) => length === side)
    : list.length === side * side;
  if (!isWhole) {
    const given = isNested ? `rows of ${rows.map(({ length }) => length).join(", ")}` : `${list.length} numbers`;
    throw new BimodalError(
      "size",
      `${field}: needs ${side} rows of ${side} numbers, or ${side * side} numbers row by row, not ${given}`,
      field,
    );
  }
  return rows.flat().map((value, index) => {
    const path = isNested ? `${field}[${Math.floor(index / side)}][${index % side}]` : `${field}[${index}]`;
    if (typeof value !== "number") throw wrong(path, "a number", value);
    if (!Number.isFinite(value)) throw range(path, `must be a finite number (got ${value})`, value);
    return value;
  });
}

/** The determinant of nine numbers row by row. */
export function determinant(r: Numbers): number {
  const minor = (a: number, b: number, c: number, d: number) => at(r, a) * at(r, d) - at(r, b) * at(r, c);
  return at(r, 0) * minor(4, 5, 7, 8) - at(r, 1) * minor(3, 5, 6, 8) + at(r, 2) * minor(3, 4, 6, 7);
}

/** R = Rx(alpha) Ry(beta) Rz(gamma), degrees. */
export function anglesOf(r: Numbers): Pose["angles"] {
  const degrees = 180 / Math.PI;
  const cosine = Math.hypot(at(r, 0), at(r, 1));
  // As in src/pose/angles.rs: at a pole only alpha and gamma together are determined, and alpha is zero.
  const alpha = cosine < 1e-6 ? 0 : Math.atan2(-at(r, 5), at(r, 8));
  const [s, c] = [Math.sin(alpha), Math.cos(alpha)];
  const gamma = Math.atan2(c * at(r, 3) + s * at(r, 6), c * at(r, 4) + s * at(r, 7));
  return { alpha: alpha * degrees, beta: Math.atan2(at(r, 2), cosine) * degrees, gamma: gamma * degrees };
}

/** The 4x4 matrix of a pose, four rows of four numbers. */
export function matrixOf({ scale, rotation, translation }: PoseMembers): number[][] {
  const row = (i: number) => [0, 1, 2].map((j) => scale * at(rotation, 3 * i + j)).concat(at(translation, i));
  return [row(0), row(1), row(2), [0, 0, 0, 1]];
}

/** The scale, rotation and translation of a 4x4 matrix. */
function ofMatrix4(matrix: Matrix4, field: string): PoseMembers {
  const m = entries(matrix, 4, field);
  const other = [12, 13, 14, 15].find((index) => !near(at(m, index), index === 15 ? 1 : 0));
  if (other !== undefined)
    throw range(field, `its last row must be 0 0 0 1 (got ${m.slice(12).join(" ")})`, m[other], other);
  const upper = [0, 1, 2].flatMap((i) => m.slice(4 * i, 4 * i + 3));
  const size = Math.cbrt(determinant(upper));
  if (!(size > 0))
    throw range(field, "its upper left 3x3 must be a positive scale times a rotation; this one mirrors or flattens");
  const scale = near(size, 1) ? 1 : size;
  return { scale, rotation: upper.map((value) => value / scale), translation: [3, 7, 11].map((index) => at(m, index)) };
}

/** A pose with its matrix as members; a value without a matrix passes unchanged. */
export function poseOf(value: unknown, field: string): unknown {
  if (isMatrix(value)) return ofMatrix4(value as Matrix4, field);
  if (!isObject(value) || !("matrix" in value)) return value;
  const { matrix, ...members } = value;
  if (matrix === undefined) return members;
  // A reported pose has angles and a rotation. If the caller changed the rotation, the rotation counts.
  if ("rotation" in value && value.rotation !== undefined) return Object.hasOwn(value, "matrix") ? members : value;
  if (!isMatrix(matrix)) throw wrong(`${field}.matrix`, "a 4x4 matrix", matrix);
  return { ...members, ...ofMatrix4(matrix as Matrix4, `${field}.matrix`) };
}

/** A pose with all members including its angles, either from a matrix or from its members. */
export function wholePoseOf(value: unknown, field: string): Pose {
  const pose = poseOf(value, field);
  const isWhole = !isObject(pose) || "angles" in pose || !("rotation" in pose);
  return (isWhole ? pose : { ...pose, angles: anglesOf(Array.from(pose.rotation as ArrayLike<number>)) }) as Pose;
}

function ofMatrix3(matrix: Matrix3, field: string): CameraMembers {
  const k = entries(matrix, 3, field);
  const [fx, skew, cx, , fy, cy] = k as [number, number, number, number, number, number];
  if (!near(skew / fx, 0))
    throw range(field, `a camera with skew is not supported (got ${skew} in row 1, column 2)`, skew, 1);
  const other = [3, 6, 7, 8].find((index) => (index === 8 ? !near(at(k, 8), 1) : at(k, index) !== 0));
  if (other !== undefined) throw range(field, "must be fx 0 cx, 0 fy cy, 0 0 1", k[other], other);
  return { fx, fy, cx, cy };
}

/** A camera with its matrix K as members; a value without a matrix passes unchanged. */
export function cameraOf(value: unknown, field: string): unknown {
  if (isMatrix(value)) return ofMatrix3(value as Matrix3, field);
  if (!isObject(value) || !("K" in value) || value.K === undefined) return value;
  const { K, ...members } = value;
  if (!isMatrix(K)) throw wrong(`${field}.K`, "a 3x3 matrix", K);
  const twice = (["fx", "fy", "cx", "cy"] as const).find((name) => Reflect.get(value, name) !== undefined);
  if (twice !== undefined)
    throw new BimodalError(
      "option",
      `${field}.${twice}: K already contains it; leave one of them out`,
      `${field}.${twice}`,
    );
  return { ...members, ...ofMatrix3(K as Matrix3, `${field}.K`) };
}
