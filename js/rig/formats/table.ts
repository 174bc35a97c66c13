/**
 * Texts that are tables of numbers: a depth map row by row (CSV, TXT of numpy.savetxt or MATLAB), or a list of points (XYZ, PTS, PTX, ASC).
 *
 * A depth map is told from matrices and trajectories by its size. Limits: a table needs the same number of columns in each row.
 */
import { type BimodalError, badFile } from "../../errors.js";
import { numberOf } from "./numbers.js";
import { MOST_SIDE, checkSize } from "./limits.js";
import type { Picture } from "./picture.js";

/** Matrices and rows of trajectories are smaller than the smallest depth map. */
const [FEWEST_COLUMNS, FEWEST_ROWS] = [24, 18];
/** Share of its first rows that have to have as many numbers as the first one. */
const MOSTLY = 0.9;
/** Lines by which a text is told. */
const HEAD = 40;
/** Characters of them. */
const HEAD_CHARACTERS = 2 ** 19;
/** Points of a list, at least: fewer are a matrix or a short trajectory. */
const FEWEST_POINTS = 20;
/** x y z, intensity, colours, normals. */
const MOST_OF_POINT = 10;
/** How far from 1 the length of a quaternion may be. */
const SLACK = 0.01;

const isComment = (line: string): boolean => /^\s*(?:[#%]|\/\/|$)/.test(line);
const isHole = (word: string): boolean => /^[-+]?(?:nan|inf|infinity|none|null|na)?$/i.test(word);

/** How the words of a line are parted; with semicolons a comma is that of a decimal. */
function splitter(line: string): (line: string) => string[] {
  if (line.includes(";")) return (each) => each.replace(/,/g, ".").split(";");
  if (line.includes(",")) return (each) => each.split(",");
  return (each) => each.trim().split(/\s+/);
}

export const wordsOf = (line: string, split: (line: string) => string[]): string[] =>
  split(line).map((word) => word.trim().replace(/^"(.*)"$/, "$1"));

/** Some programs end each line by the separator, and some leave holes empty, also at the end of a line. */
const isTrailing = (rows: string[][]): boolean =>
  rows.length > 0 && rows.filter((row) => row.at(-1) === "").length >= MOSTLY * rows.length;

export const isNumbers = (words: string[]): boolean =>
  words.every((word) => isHole(word) || numberOf(word) !== undefined);

/** The first lines that are no comments, in words. */
export function headOf(bytes: Uint8Array): { rows: string[][]; split: (line: string) => string[] } {
  const text = new TextDecoder("latin1").decode(bytes.subarray(0, HEAD_CHARACTERS)).replace(/^ï»¿/, "");
  const lines = text.split(/\r?\n/).slice(0, HEAD);
  // What may be cut off within a line says nothing.
  if (bytes.length > HEAD_CHARACTERS && lines.length > 1 && lines.length < HEAD) lines.pop();
  const used = lines.filter((line) => !isComment(line));
  const words = splitter(used[1] ?? used[0] ?? "");
  const trailing = isTrailing(used.map((line) => wordsOf(line, words)));
  const split = (line: string) => {
    const found = wordsOf(line, words);
    return trailing && found.at(-1) === "" ? found.slice(0, -1) : found;
  };
  return { rows: used.map(split), split };
}

/** Whether a text is a table of the size of a depth map: of its first lines, that those are rows of as many numbers. */
export function isTable(bytes: Uint8Array): boolean {
  const { rows } = headOf(bytes);
  // The first row may name the columns.
  const [first, ...others] = rows[0] !== undefined && isNumbers(rows[0]) ? rows : rows.slice(1);
  if (first === undefined || first.length < FEWEST_COLUMNS || first.length > MOST_SIDE + 1) return false;
  // A damaged row is named when the table is read.
  const alike = others.filter((row) => row.length === first.length && isNumbers(row));
  return rows.length >= FEWEST_ROWS && alike.length >= MOSTLY * others.length;
}

/** Whether numbers count 0, 1, 2 .., as the names that pandas gives rows and columns. */
const counts = (values: number[]): boolean => values.length > 1 && values.every((value, at) => value === at);

/** A table as a raster of floats; what is empty, NaN or infinite is a hole. */
export function readTable(bytes: Uint8Array): Picture {
  const { split } = headOf(bytes);
  const rows: number[][] = [];
  for (const line of new TextDecoder("latin1").decode(bytes).replace(/^ï»¿/, "").split(/\r?\n/)) {
    if (isComment(line)) continue;
    const words = split(line);
    if (rows.length === 0 && !isNumbers(words)) continue;
    if (rows.length > MOST_SIDE) throw badFile(`its table has more than ${MOST_SIDE} rows`);
    const width = rows[0]?.length ?? words.length;
    if (words.length !== width)
      throw badFile(`its table has ${words.length} columns in row ${rows.length + 1}, and ${width} in those before`);
    rows.push(words.map((word) => ofWord(word, rows.length)));
  }
  if (rows.length > 1 && (counts(rows[0] ?? []) || counts((rows[0] ?? []).slice(1)))) rows.shift();
  if (counts(rows.map((row) => row[0] ?? NaN))) for (const row of rows) row.shift();
  const [height, width] = [rows.length, rows[0]?.length ?? 0];
  checkSize(width, height);
  return {
    width,
    height,
    channels: 1,
    ...levels(rows.flat()),
    format: "table",
    notes: ["a table as text"],
    warnings: [],
  };
}

function ofWord(word: string, row: number): number {
  if (isHole(word)) return NaN;
  const value = numberOf(word);
  if (value === undefined)
    throw badFile(`its table has ${JSON.stringify(word.slice(0, 20))} in row ${row + 1}, where a number is needed`);
  return value;
}

/** Whole numbers of 16 bits as depth cameras write them, others as floats. */
function levels(values: number[]): Pick<Picture, "data" | "bits"> {
  const isLevel = (value: number) => Number.isNaN(value) || (Number.isInteger(value) && value <= 0xffff);
  if (values.every(isLevel)) return { data: Uint16Array.from(values, (value) => Math.max(0, value || 0)), bits: 16 };
  return { data: new Float32Array(values), bits: 32 };
}

const isUnit = (quaternion: number[]): boolean => Math.abs(Math.hypot(...quaternion) - 1) < SLACK;

/** Rows of a trajectory end in a quaternion, of either order. */
const isTrajectory = (rows: number[][]): boolean =>
  rows.every((row) => (row.length === 7 || row.length === 8) && isUnit(row.slice(-4)));

/** The error about a list of points as text; nothing where it is none. */
export function pointList(bytes: Uint8Array): BimodalError | undefined {
  const { rows } = headOf(bytes);
  const single = (row: string[] | undefined) => row?.length === 1 && /^\d+$/.test(row[0] ?? "");
  const points =
    "in no rows and columns (unorganised), so that no neighbours are known; save them as an organised cloud (PLY, PCD) or as a depth map";
  if (single(rows[0]) && single(rows[1]) && rows.slice(2, 6).every((row) => row.length === 3))
    return badFile(
      "it is a scan in PTX: points in rows and columns, but in the scanner's axes; save it as an organised PLY or PCD with z forward, or as a depth map",
    );
  const body = single(rows[0]) || (rows[0] !== undefined && !isNumbers(rows[0])) ? rows.slice(1) : rows;
  const columns = body[0]?.length ?? 0;
  if (body.length < FEWEST_POINTS || columns < 3 || columns > MOST_OF_POINT) return undefined;
  if (!body.every((row) => row.length === columns && isNumbers(row))) return undefined;
  const isNamed = body !== rows && !single(rows[0]);
  const names = (rows[0] ?? []).map((name) => name.replace(/^\/+/, "").toLowerCase());
  if (
    isNamed &&
    (!names.includes("x") || !names.includes("z") || names.some((name) => /^q[wxyz]$|time|frame/.test(name)))
  )
    return undefined;
  const numbers = body.map((row) => row.map((word) => numberOf(word) ?? NaN));
  if (isTrajectory(numbers) || isLog(numbers)) return undefined;
  return badFile(`it is a list of points as text (${columns} numbers each), ${points}`);
}

/** Redwood's trajectories: three whole numbers, then a matrix of 4x4. */
const isLog = (rows: number[][]): boolean => rows.some((row) => row.length !== rows[0]?.length) || isMatrices(rows);
/** Matrices of 4x4 or 3x3 below each other end in 0 0 0 1. */
function isMatrices(rows: number[][]): boolean {
  const side = rows[0]?.length ?? 0;
  if (side !== 3 && side !== 4) return false;
  const last = rows.filter((_, at) => at % side === side - 1);
  return last.every((row) => row.every((value, at) => value === (at === side - 1 ? 1 : 0)));
}
