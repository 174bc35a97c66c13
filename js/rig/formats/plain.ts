/** Files that contain only numbers: K.txt, matrices of motions, and trajectories in the formats of TUM and Redwood. */
import { badFile } from "../../errors.js";
import type { NamedPose } from "../types.js";
import { cameraOf, ofMatrix } from "./cameras.js";
import { PROJECTION, forColumns, intrinsicsOf4x4, isProjection } from "./blocks.js";
import { checkLength, unitInComments } from "./lengths.js";
import { type Numbers, numberOf } from "./numbers.js";
import { motion, motionOfMatrix } from "./poses.js";
import type { Calibration } from "./tree.js";
import { ofFour } from "./turns.js";
import { type ReaderWarning, distinct } from "../warnings.js";

type Found = Calibration & { format: string };

const MOST_NUMBERS = 200_000;
/** Number of characters in which a header of names is searched. */
const HEAD = 1000;
const near = (value: number | undefined, to: number): boolean => value !== undefined && Math.abs(value - to) < 1e-9;

/** Rows of numbers, without comments and brackets; undefined if the text contains anything else. */
function rowsOf(text: string): Numbers[] | undefined {
  const rows: Numbers[] = [];
  let count = 0;
  for (const line of text.split(/\r?\n/)) {
    const parts = line
      .replace(/(?:#|\/\/|%).*$/, "")
      .split(/[\s,;[\]()]+/)
      .filter((part) => part !== "");
    if (parts.length === 0) continue;
    const numbers: Numbers = [];
    for (const part of parts) {
      const number = /^[-+]?(?:nan|inf(?:inity)?)$/i.test(part) ? NaN : numberOf(part);
      if (number === undefined) return undefined;
      numbers.push(number);
    }
    count += numbers.length;
    if (count > MOST_NUMBERS)
      throw badFile(`it has more than ${MOST_NUMBERS} numbers, too many for cameras and transforms`);
    rows.push(numbers);
  }
  return rows;
}

const camera = (k: Numbers, size: Numbers, distortion: Numbers = []): Found => {
  const warnings: ReaderWarning[] = [];
  const raw = { ...ofMatrix(k), distortion, width: size[0], height: size[1] };
  return { cameras: [cameraOf(raw, warnings)], poses: [], warnings, format: "a matrix of intrinsics" };
};

const cameraMatrix = ([fx = NaN, fy = NaN, cx = NaN, cy = NaN]: Numbers): Numbers => [fx, 0, cx, 0, fy, cy, 0, 0, 1];

/** Nine numbers: a matrix of intrinsics, or a rotation without its translation. */
function nine(values: Numbers, size: Numbers): Found {
  if (near(values[3], 0) && near(values[6], 0) && near(values[7], 0) && near(values[8], 1)) return camera(values, size);
  if (near(values[1], 0) && near(values[2], 0) && near(values[5], 0) && near(values[8], 1)) {
    throw badFile("its matrix of intrinsics is transposed: transpose it, because fx 0 cx / 0 fy cy / 0 0 1 are needed");
  }
  throw badFile(
    "its nine numbers are not a matrix of intrinsics (fx 0 cx / 0 fy cy / 0 0 1), and a rotation needs its translation",
  );
}

/** Possible numbers of distortion coefficients that OpenCV writes. */
const LENSES = [4, 5, 8, 12, 14];
const isK = (k: Numbers): boolean =>
  k.length === 9 && [3, 6, 7].every((at) => near(k[at], 0)) && near(k[8], 1) && Math.min(k[0] ?? 0, k[4] ?? 0) > 10;

/** A matrix of intrinsics, a line of OpenCV's distortion and, in some files, a motion below it. The first line may be a size. */
function withLens(rows: Numbers[], text: string): Found | undefined {
  const size = rows[0]?.length === 2 ? rows.slice(0, 1) : [];
  const body = rows.slice(size.length);
  const count = body[0]?.length === 9 ? 1 : 3;
  const [k, lens] = [body.slice(0, count).flat(), body[count] ?? []];
  const motion = body.slice(count + 1);
  if (!isK(k) || body.slice(0, count).some((row) => row.length !== 9 / count) || !LENSES.includes(lens.length))
    return undefined;
  const isMotion = [3, 4].includes(motion.length) && motion.every((row) => row.length === 4);
  if (motion.length > 0 && !isMotion) return undefined;
  const found = camera(k, size.flat(), lens);
  if (isMotion) found.poses.push(aloneOf(motion.flat(), text, found.warnings));
  return found;
}

/** "fx fy cx cy k1 k2 p1 p2" in one line, rather than a time, a translation and a quaternion. */
function isCameraOfEight([row = [], ...others]: Numbers[]): boolean {
  const [fx = 0, fy = 0, cx = 0, cy = 0] = row;
  if (others.length > 0 || row.length !== 8 || Math.min(fx, fy, cx, cy) <= 10 || fx > 2 * fy || fy > 2 * fx)
    return false;
  if (Math.abs(Math.hypot(...row.slice(4)) - 1) < UNIT_SLACK)
    throw badFile(
      "its eight numbers may be fx fy cx cy k1 k2 p1 p2 or a time, a translation and a quaternion; write the camera as a matrix of 3x3 above a line of its distortion, or the pose as a matrix of 4x4",
    );
  return true;
}
/** Largest difference of a written quaternion's length from 1. */
const UNIT_SLACK = 0.01;

/** ARKitScenes' .pincam: "width height fx fy cx cy" in one line. */
function isPincam(rows: Numbers[]): boolean {
  const [w = 0, h = 0, fx = 0, fy = 0, cx = 0, cy = 0] = rows[0] ?? [];
  if (rows.length !== 1 || rows[0]?.length !== 6) return false;
  const areSides = [w, h].every((side) => Number.isInteger(side) && side >= 16);
  return areSides && Math.min(fx, fy) > 10 && Math.min(cx, cy) > 0 && cx < w && cy < h;
}

/** TUM's trajectory: time stamp, translation and quaternion x y z w of the camera in the world. */
function trajectory(rows: Numbers[], text: string): Found {
  const warnings: ReaderWarning[] = [];
  const isFirst = /\bq\w*?_?w\b[^\n]*\bq\w*?_?x\b|\bw[\s,;]+x[\s,;]+y[\s,;]+z\b/i.test(text.slice(0, HEAD));
  const isSeries = rows.length > 1 || rows[0]?.length === 8;
  const poses = rows.map((row) => {
    const [x = NaN, y = NaN, z = NaN, a = NaN, b = NaN, c = NaN, d = NaN] = row.slice(-7);
    const name = row.length === 8 ? { name: String(row[0]) } : {};
    const names = isSeries ? { ...name, from: "camera", to: "world" } : {};
    const said = isFirst ? { order: "wxyz" as const } : isSeries ? { order: "xyzw" as const } : {};
    return motion(ofFour([a, b, c, d], said, "the last four numbers", warnings), [x, y, z], names, warnings, !isSeries);
  });
  return {
    cameras: [],
    poses,
    warnings: distinct(warnings, 4),
    format: rows.length === 1 ? "a translation and a quaternion" : "a trajectory",
  };
}

/** Redwood's trajectory: three integers, then the 4x4 pose of the camera in the world. */
function log(rows: Numbers[]): Found {
  const warnings: ReaderWarning[] = [];
  const poses = Array.from({ length: rows.length / 5 }, (_, index) => {
    const names = { name: String(rows[5 * index]?.[0]), from: "camera", to: "world" };
    return motionOfMatrix(rows.slice(5 * index + 1, 5 * index + 5).flat(), names, warnings, false);
  });
  return { cameras: [], poses, warnings: distinct(warnings, 4), format: "a trajectory" };
}

/** KITTI's trajectory: the 3x4 or 4x4 pose of the camera in the world in each row. */
function matrices(rows: Numbers[]): Found {
  const warnings: ReaderWarning[] = [];
  const poses = rows.map((row, index) =>
    motionOfMatrix(row, { name: String(index), from: "camera", to: "world" }, warnings, false),
  );
  return { cameras: [], poses, warnings: distinct(warnings, 4), format: "a trajectory" };
}

/** The motion of a file without names, in the unit that its comments state. */
function aloneOf(read: Numbers, text: string, warnings: ReaderWarning[]): NamedPose {
  const unit = unitInComments(text);
  if (isProjection(read)) throw badFile(`its matrix ${PROJECTION}`);
  const values = forColumns(read, "", warnings);
  const metres = values.map((value, at) => (at % 4 === 3 && at < 12 ? value * (unit ?? 1) : value));
  const pose = motionOfMatrix(metres, {}, warnings, unit === undefined);
  if (unit === undefined) checkLength(pose, warnings);
  return pose;
}

/** The camera or the poses of a text of numbers; undefined where it has words. */
export function readNumbers(text: string): Found | undefined {
  const rows = rowsOf(text);
  if (rows === undefined || rows.length === 0) return undefined;
  const values = rows.flat();
  if (values.some(Number.isNaN)) throw badFile("it has nan or inf where numbers are needed");
  const widths = new Set(rows.map((row) => row.length));
  const [width] = widths;
  if (rows.length % 5 === 0 && rows.every((row, index) => row.length === (index % 5 === 0 ? 3 : 4))) return log(rows);
  const lensed = withLens(rows, text);
  if (lensed !== undefined) return lensed;
  if (isCameraOfEight(rows)) return camera(cameraMatrix(values), [], values.slice(4));
  if (widths.size === 1 && (width === 8 || width === 7) && rows.length >= 1) return trajectory(rows, text);
  if (widths.size === 1 && (width === 12 || width === 16) && rows.length >= 2) return matrices(rows);
  const size = rows[0]?.length === 2 && values.length === 11 ? values.slice(0, 2) : [];
  const isLine = rows.length === 1 && !near(values[8], 1);
  if (values.length - size.length === 9 && !isLine) return nine(values.slice(size.length), size);
  // FoundationStereo's K.txt has the baseline in its second line.
  if (rows.length === 2 && rows[0]?.length === 9 && rows[1]?.length === 1) return nine(values.slice(0, 9), []);
  const k = intrinsicsOf4x4(values);
  if (k !== undefined) return camera(k, []);
  if (isPincam(rows)) {
    const [, , fx = NaN, fy = NaN, cx = NaN, cy = NaN] = values;
    return camera(cameraMatrix([fx, fy, cx, cy]), values.slice(0, 2));
  }
  if (values.length === 12 || values.length === 16) {
    const warnings: ReaderWarning[] = [];
    return { cameras: [], poses: [aloneOf(values, text, warnings)], warnings, format: "a matrix of a transform" };
  }
  const [fx = 0, fy = 0, , , ...lens] = values;
  if (rows.length === 1 && [4, 9, 12].includes(values.length) && fx > 10 && fy > 10)
    return camera(cameraMatrix(values), [], lens);
  throw badFile(
    `it has ${values.length} numbers in ${rows.length} rows; it needs 3x3 numbers of intrinsics, 3x4 or 4x4 of a transform, or the rows of a trajectory`,
  );
}
