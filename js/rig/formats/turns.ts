/**
 * Rotations whose numbers can be read in more than one way: quaternions with w first or last, three angles or a vector, degrees or radians,
 * rows or columns.
 *
 * Words of the file decide where they say it. Elsewhere the reading that makes a rig is taken, that of cameras which look nearly the same
 * way, and a warning says so. Limit: where both readings make a rig, or neither does, the common one is taken, with the warning.
 */
import { badFile } from "../../errors.js";
import { type ReaderWarning, warning } from "../warnings.js";
import type { Attributes } from "./names.js";
import { type Numbers, transposed } from "./numbers.js";
import { ofQuaternion, ofVector, ofYawPitchRoll } from "./poses.js";

/** Cameras of one rig look the same way within this, degrees: more than any depth camera's own two, less than a side view. */
const PARALLEL = 45;
/** Angles this near to multiples of 90 degrees turn from one convention of axes into another, radians. */
const AXES = 0.15;
/** Readings that differ by less than this need no warning, degrees: the digits of a file differ by more. */
const ALIKE = 0.05;
const RADIAN = 180 / Math.PI;

/** What was read, and how. */
export interface Turn {
  rotation: Numbers;
  /** Rows may be columns: nothing in the file says which. */
  isOrderOpen?: boolean;
}

/** The angle of a rotation, degrees. */
export const degreesOf = (r: Numbers): number =>
  RADIAN * Math.acos(Math.min(1, Math.max(-1, ((r[0] ?? 0) + (r[4] ?? 0) + (r[8] ?? 0) - 1) / 2)));
const isRig = (r: Numbers): boolean => degreesOf(r) <= PARALLEL;
const between = (a: Numbers, b: Numbers): number => Math.hypot(...a.map((value, at) => value - (b[at] ?? 0))) * RADIAN;

/** A quaternion as a list of four. */
export function ofFour(values: Numbers, { order }: Attributes, name: string, warnings: ReaderWarning[]): Numbers {
  const [a = 0, b = 0, c = 0, d = 0] = values;
  if (order === "wxyz") return ofQuaternion([b, c, d, a], warnings);
  const last = ofQuaternion(values, warnings);
  if (order === "xyzw" || isRig(last)) return last;
  const first = ofQuaternion([b, c, d, a], []);
  if (isRig(first)) {
    warnings.push(
      warning(
        "quaternion-order",
        `The quaternion "${name}" was read as w x y z, which turns by ${degreesOf(first).toFixed(1)} degrees; as x y z w it would turn by ${degreesOf(last).toFixed(1)}. Name it quaternion_wxyz or quaternion_xyzw to say its order.`,
        { order: "wxyz" },
      ),
    );
    return first;
  }
  warnings.push(
    warning(
      "quaternion-order",
      `The quaternion "${name}" was read as x y z w; nothing says its order. Name it quaternion_wxyz or quaternion_xyzw.`,
      { order: "xyzw" },
    ),
  );
  return last;
}

/** Angles about fixed axes, x first, as ROS's roll, pitch and yaw. */
const ofAngles = ([x = 0, y = 0, z = 0]: Numbers, isDegrees: boolean): Numbers =>
  ofYawPitchRoll([z, y, x].map((angle) => (isDegrees ? angle / RADIAN : angle)));

/** Whether angles in radians only turn the axes of a body or of a LiDAR into those of a camera. */
const turnsAxes = (values: Numbers): boolean => {
  const quarters = values.map((value) => Math.round(value / (Math.PI / 2)));
  const isNear = values.every((value, at) => Math.abs(value - ((quarters[at] ?? 0) * Math.PI) / 2) < AXES);
  return isNear && quarters.some((quarter) => quarter !== 0);
};

/** Degrees where the file says so, where radians would be too many, or where degrees alone make a rig. */
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
        `The rotation vector "${name}" is ${length.toPrecision(4)} long, which is more than pi; it was read in radians. If it holds degrees, name it rotation_degrees.`,
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
      `The three numbers of "${name}" were read as a rotation vector in radians, ${(length * RADIAN).toFixed(1)} degrees in all; Euler angles in radians would be ${apart.toFixed(2)} degrees from it. Name them rvec or rpy_degrees to say what they are.`,
      "vector",
    );
    return rotation;
  }
  guess(
    `The three numbers of "${name}" were read as Euler angles in ${isDegrees ? "degrees" : "radians"}, about the fixed axes x, y and z in this order (roll, pitch, yaw of ROS), ${degreesOf(turned).toFixed(1)} degrees in all. Give the rotation as a matrix if they are others.`,
    isDegrees ? "euler-degrees" : "euler-radians",
  );
  return turned;
}

/** What is known of nine numbers beside themselves. */
export interface Layout {
  /** The file says its rows, as lists of lists or as rows and columns of a matrix. */
  rows?: number | undefined;
  /** .. as OpenCV's and ROS's matrices, which are written row by row. */
  isMatrix: boolean;
  /** The members are called rotation and translation, as librealsense calls its own. */
  isNamedAsRealSense: boolean;
  /** The file has other signs of librealsense. */
  isRealSense: boolean;
}

/** Nine numbers. librealsense keeps its rotations column by column, everybody else writes rows. */
export function ofNine(values: Numbers, { rows, isMatrix, isNamedAsRealSense, isRealSense }: Layout): Turn {
  if (!isNamedAsRealSense || isMatrix) return { rotation: values };
  const isFlat = rows === undefined;
  const rotation = isFlat && isRealSense ? transposed(values, 3) : values;
  const isOpen = between(values, transposed(values, 3)) > ALIKE && !(isFlat && isRealSense);
  return { rotation, ...(isOpen && { isOrderOpen: true }) };
}

export const orderWarning = (name: string, isByColumns: boolean): ReaderWarning =>
  warning(
    "rotation-order",
    `The rotation${name === "" ? "" : ` of "${name}"`} was read ${isByColumns ? "column by column, as librealsense writes it" : "row by row; librealsense writes it column by column, the transposed"}, and nothing in the file says which. Write a 4x4 matrix, or R and t with three rows.`,
    { order: isByColumns ? "columns" : "rows" },
  );

/** Three or four numbers, or nine. */
export function numbersAsRotation(values: Numbers, key: string): "quaternion" | "three" | "nine" {
  if (values.length === 9) return "nine";
  if (values.length === 4) return "quaternion";
  if (values.length === 3) return "three";
  throw badFile(
    `its ${key} has ${values.length} numbers: 9 of a matrix, 4 of a quaternion or 3 of a vector are needed`,
  );
}
