/** Texts that are lists of points (XYZ, PTS, PTX, ASC, CSV), by their first lines. */
import { type BimodalError, badFile } from "../../errors.js";
import { FEWEST_POINTS, channelOf } from "./channels.js";
import { lengthOf } from "./names.js";
import { numberOf } from "./numbers.js";
import { headOf, isNumbers } from "./table.js";

/** Smallest number of lines of a list of points; a shorter text is a matrix or a short trajectory. */
const FEWEST_LINES = 20;
/** Largest number of columns of a point without names: x y z, intensity, colours, normals. */
const MOST_OF_POINT = 10;
/** Largest difference of a quaternion's length from 1. */
const SLACK = 0.01;
/** ParaView, and so VeloView and LidarView, writes the axes of an array as "Points_m_XYZ:0" or "Points_0". */
const AXIS_OF_ARRAY = /^points(?:_([a-z]{1,3}))?(?:_xyz)?[:_]([012])$/;
/** Column names such as "x", "X [m]", "x(mm)" and "x_m". */
const AXIS = /^([xyz])(?:\s*[[(]\s*([a-z]+)\s*[\])]|_(m|cm|mm))?$/;

export interface PointColumns {
  /** The columns of x, y and z. */
  axes: number[];
  names: string[];
  /** Metres per unit, if the columns' names state it. */
  unit?: number;
}

interface Axis {
  axis: number;
  unit: string | undefined;
}

function axisOf(name: string): Axis | undefined {
  const [, unit, index] = AXIS_OF_ARRAY.exec(name) ?? [];
  if (index !== undefined) return { axis: Number(index), unit };
  const [, letter, enclosed, appended] = AXIS.exec(name) ?? [];
  return letter === undefined ? undefined : { axis: "xyz".indexOf(letter), unit: enclosed ?? appended };
}

/** The columns of x, y and z by their names; undefined where one is missing. */
export function pointColumns(row: string[]): PointColumns | undefined {
  const plain = row.map((name) =>
    name
      .trim()
      .replace(/^\/+|^scalar_/gi, "")
      .toLowerCase(),
  );
  const found = plain.map(axisOf);
  const axes = [0, 1, 2].map((axis) => found.findIndex((each) => each?.axis === axis));
  if (axes.includes(-1)) return undefined;
  const units = axes.map((column) => lengthOf(found[column]?.unit ?? ""));
  const names = plain.map((name) => name.replace(/\s*[[(].*$/, ""));
  const [unit] = units;
  return { axes, names, ...(unit !== undefined && units.every((each) => each === unit) && { unit }) };
}

/** Whether named columns hold poses over time. A column with a LiDAR's measurement makes them points instead. */
function arePoses(names: string[]): boolean {
  if (names.some((name) => /^q_?[wxyz]$/.test(name))) return true;
  const isMeasured = names.some((name) => ["ring", "intensity"].includes(channelOf(name) ?? ""));
  return !isMeasured && names.some((name) => /time|frame/.test(name));
}

/** The error about a list of points as text that cannot be read; undefined where the text is not such a list. */
export function pointList(bytes: Uint8Array): BimodalError | undefined {
  const { rows } = headOf(bytes);
  const single = (row: string[] | undefined) => row?.length === 1 && /^\d+$/.test(row[0] ?? "");
  if (single(rows[0]) && single(rows[1]) && rows.slice(2, 6).every((row) => row.length === 3))
    return badFile(
      "it is a scan in PTX, whose points have the scanner's axes; save it as an organised PLY or PCD with z forward, or as a depth map",
    );
  const isNamed = rows[0] !== undefined && !single(rows[0]) && !isNumbers(rows[0]);
  const body = single(rows[0]) || isNamed ? rows.slice(1) : rows;
  const columns = body[0]?.length ?? 0;
  if (body.length < FEWEST_LINES || columns < 3 || body.some((row) => row.length !== columns)) return undefined;
  if (!(isNamed ? areNamed(rows[0] ?? [], body) : columns <= MOST_OF_POINT && body.every(isNumbers))) return undefined;
  const numbers = body.map((row) => row.map((word) => numberOf(word) ?? NaN));
  if (isTrajectory(numbers) || isMatrices(numbers)) return undefined;
  return badFile(
    `it is a list of points as text (${columns} numbers each) without rows and columns (unorganised); such a list needs x, y, z and at least ${FEWEST_POINTS} points`,
  );
}

/** Whether rows have the coordinates of a point by name; their other columns, such as the flags of a driver, may hold anything. */
function areNamed(names: string[], body: string[][]): boolean {
  const found = pointColumns(names);
  if (found === undefined || arePoses(found.names)) return false;
  return body.every((row) => isNumbers(found.axes.map((column) => row[column] ?? "nothing")));
}

const isUnit = (quaternion: number[]): boolean => Math.abs(Math.hypot(...quaternion) - 1) < SLACK;

/** Whether all rows end in a quaternion, in either order. */
const isTrajectory = (rows: number[][]): boolean =>
  rows.every((row) => (row.length === 7 || row.length === 8) && isUnit(row.slice(-4)));

/** Whether the rows are matrices of 4x4 or 3x3, which end in 0 0 0 1 or 0 0 1. */
function isMatrices(rows: number[][]): boolean {
  const side = rows[0]?.length ?? 0;
  if (side !== 3 && side !== 4) return false;
  const last = rows.filter((_, at) => at % side === side - 1);
  return last.every((row) => row.every((value, at) => value === (at === side - 1 ? 1 : 0)));
}
