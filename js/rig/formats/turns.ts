/**
 * Rotations whose numbers can be read in more than one way: quaternions with w first or last, Euler angles or a rotation vector, degrees or
 * radians, rows or columns.
 *
 * Words in the file decide if there are any. Otherwise the reading is chosen under which the cameras look in nearly the same direction (a
 * rig), with a warning. Limit: if both readings make a rig, or neither does, the more common one is used, with a warning.
 */
import { badFile } from "../../errors.js";
import { type ReaderWarning, warning } from "../warnings.js";
import type { Attributes } from "./names.js";
import { type Numbers, transposed } from "./numbers.js";
import { degreesOf, ofQuaternion, ofScalarFirst, ofVector, ofYawPitchRoll } from "./poses.js";

/** Largest angle between the cameras of a rig, degrees: larger than within any depth camera, smaller than to a side view. */
const PARALLEL = 45;
/** Tolerance in radians about multiples of 90 degrees. Angles within it are changes between conventions of axes. */
const AXES = 0.15;
/** Readings that differ by less than this need no warning, degrees; the digits of a file differ by more. */
const ALIKE = 0.05;
const RADIAN = 180 / Math.PI;

export interface Turn {
  rotation: Numbers;
  /** The reading of nine numbers if the file does not state whether they are rows or columns. */
  assumed?: "rows" | "columns";
}

const isRig = (r: Numbers): boolean => degreesOf(r) <= PARALLEL;
const between = (a: Numbers, b: Numbers): number => Math.hypot(...a.map((value, at) => value - (b[at] ?? 0))) * RADIAN;

/** Cosine of 45 degrees; within this angle a direction is nearer to an axis than to any other. */
const NEAR = Math.SQRT1_2;

/** Whether a camera is upright on a LiDAR or a vehicle (x forward, z up) and looks forward. Its rotation or the inverse may be given. */
const looksForward = (r: Numbers): boolean =>
  ((r[5] ?? 0) < -NEAR && (r[6] ?? 0) > NEAR) || ((r[7] ?? 0) < -NEAR && (r[2] ?? 0) > NEAR);

/** A quaternion as a list of four. */
export function ofFour(values: Numbers, { order }: Attributes, name: string, warnings: ReaderWarning[]): Numbers {
  if (order === "wxyz") return ofScalarFirst(values, warnings);
  const last = ofQuaternion(values, warnings);
  if (order === "xyzw" || isRig(last)) return last;
  const first = ofScalarFirst(values, []);
  const isOfLidar = looksForward(first) && !looksForward(last);
  if (isRig(first) || isOfLidar) {
    const why = isOfLidar
      ? "has the camera look forward from a LiDAR (x forward, z up)"
      : `turns by ${degreesOf(first).toFixed(1)} degrees`;
    const other = isOfLidar ? "it would not" : `it would turn by ${degreesOf(last).toFixed(1)}`;
    warnings.push(
      warning(
        "quaternion-order",
        `The quaternion "${name}" was read as w x y z, which ${why}; as x y z w ${other}. Name it quaternion_wxyz or quaternion_xyzw to say its order.`,
        { order: "wxyz" },
      ),
    );
    return first;
  }
  warnings.push(
    warning(
      "quaternion-order",
      `The quaternion "${name}" was read as x y z w, because the file does not give its order. Name it quaternion_wxyz or quaternion_xyzw.`,
      { order: "xyzw" },
    ),
  );
  return last;
}

/** ROS's roll, pitch and yaw: angles about the fixed axes x, y and z, in this order. */
const ofAngles = ([x = 0, y = 0, z = 0]: Numbers, isDegrees: boolean): Numbers =>
  ofYawPitchRoll([z, y, x].map((angle) => (isDegrees ? angle / RADIAN : angle)));

/** Whether angles in radians only convert the axes of a body or a LiDAR to those of a camera. */
const turnsAxes = (values: Numbers): boolean => {
  const quarters = values.map((value) => Math.round(value / (Math.PI / 2)));
  const isNear = values.every((value, at) => Math.abs(value - ((quarters[at] ?? 0) * Math.PI) / 2) < AXES);
  return isNear && quarters.some((quarter) => quarter !== 0);
};

/**
 * Whether angles are degrees: the file states it, they are too large for radians, or only in degrees do they give a possible rotation of
 * a rig.
 */
function areDegrees(values: Numbers, { angle }: Attributes): boolean {
  if (angle !== undefined) return angle === "degrees";
  if (values.some((value) => Math.abs(value) > 2 * Math.PI + 1e-6)) return true;
  return !isRig(ofAngles(values, false)) && !turnsAxes(values) && isRig(ofAngles(values, true));
}

/** Three numbers: a rotation vector or angles. */
export function ofThree(values: Numbers, said: Attributes, name: string, warnings: ReaderWarning[]): Numbers {
  const length = Math.hypot(...values);
  const guess = (message: string, as: string) => warnings.push(warning("rotation-guessed", message, { as }));
  const isLong = length > Math.PI + 1e-6;
  if (said.kind === "vector") {
    if (said.angle === "degrees") return ofVector(values.map((value) => value / RADIAN));
    if (isLong && said.angle === undefined)
      guess(
        `The rotation vector "${name}" was read in radians, but its length of ${length.toPrecision(4)} is more than pi. If it is in degrees, name it rotation_degrees.`,
        "vector",
      );
    return ofVector(values);
  }
  const isDegrees = areDegrees(values, said);
  const turned = ofAngles(values, isDegrees);
  const isEuler = said.kind === "euler" || isDegrees || isLong || (!isRig(ofVector(values)) && turnsAxes(values));
  if (!isEuler) {
    const rotation = ofVector(values);
    const apart = between(rotation, turned);
    guess(
      `The three numbers of "${name}" were read as a rotation vector in radians, of ${(length * RADIAN).toFixed(1)} degrees; as Euler angles in radians they would differ from that by ${apart.toFixed(2)} degrees. Name them rvec or rpy_degrees.`,
      "vector",
    );
    return rotation;
  }
  guess(
    `The three numbers of "${name}" were read as Euler angles in ${isDegrees ? "degrees" : "radians"}, about the fixed axes x, y and z in this order (ROS's roll, pitch, yaw), a rotation of ${degreesOf(turned).toFixed(1)} degrees. Give the rotation as a matrix if they are different angles.`,
    isDegrees ? "euler-degrees" : "euler-radians",
  );
  return turned;
}

/** How nine numbers are stored in their file. */
export interface Layout {
  /** The number of rows, where the numbers are a list of rows or a matrix with this member. */
  rows?: number | undefined;
  /** Whether the numbers are the data of a matrix of OpenCV or ROS, which is written row by row. */
  isMatrix: boolean;
  /** Whether the members are called rotation and translation, as in librealsense. */
  isNamedAsRealSense: boolean;
  /** Whether the file has other signs of librealsense. */
  isRealSense: boolean;
  /** Whether the members are at the root of the file, as in a message of realsense-ros. */
  isAtRoot: boolean;
}

/** Nine numbers. librealsense and its ROS messages have rotations column by column, all others row by row. */
export function ofNine(values: Numbers, { rows, isMatrix, isNamedAsRealSense, isRealSense, isAtRoot }: Layout): Turn {
  if (!isNamedAsRealSense || isMatrix) return { rotation: values };
  const isFlat = rows === undefined;
  const byColumns = transposed(values, 3);
  if (isFlat && isRealSense) return { rotation: byColumns };
  const order = isFlat && isAtRoot ? "columns" : "rows";
  const rotation = order === "columns" ? byColumns : values;
  return between(values, byColumns) > ALIKE ? { rotation, assumed: order } : { rotation };
}

export const orderWarning = (name: string, order: "rows" | "columns"): ReaderWarning =>
  warning(
    "rotation-order",
    `The rotation${name === "" ? "" : ` of "${name}"`} was read ${order === "columns" ? "column by column, as librealsense writes it" : "row by row, but librealsense writes it column by column"}; the file does not give the order. Write a 4x4 matrix, or R and t with three rows.`,
    { order },
  );

/** The kind of rotation that has this many numbers. */
export function numbersAsRotation(values: Numbers, key: string): "quaternion" | "three" | "nine" {
  if (values.length === 9) return "nine";
  if (values.length === 4) return "quaternion";
  if (values.length === 3) return "three";
  throw badFile(
    `its ${key} has ${values.length} numbers; a rotation needs 9 (matrix), 4 (quaternion) or 3 (vector or angles)`,
  );
}
