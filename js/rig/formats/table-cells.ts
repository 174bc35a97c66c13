/** The cells of a table of numbers as a raster. table.ts recognises such texts; this module loads with the first of them. */
import { badFile } from "../../errors.js";
import { checkSize } from "./limits.js";
import { numberOf } from "./numbers.js";
import type { Picture } from "./picture.js";
import { headOf, isComment, isHole, isNumbers } from "./table.js";

/** Largest number of numbers in a table: 1920x1080 pixels, and the names of rows and columns. */
const MOST_CELLS = 2 ** 21;
const [TAB, NEWLINE, RETURN, SPACE, QUOTE, ZERO, NINE] = [9, 10, 13, 32, 34, 48, 57];
const [PLUS, COMMA, MINUS, POINT, LOWER_E, UPPER_E] = [43, 44, 45, 46, 101, 69];

/**
 * Parses a decimal number directly from its bytes, because creating strings takes most of the time; undefined if the bytes are anything
 * else. It is more precise than the floats that are made from it.
 */
function decimal(bytes: Uint8Array, from: number, to: number, point: number): number | undefined {
  let at = from;
  const sign = () => {
    const isNegative = bytes[at] === MINUS;
    if (isNegative || bytes[at] === PLUS) at++;
    return isNegative ? -1 : 1;
  };
  const isDigit = () => at < to && (bytes[at] ?? 0) >= ZERO && (bytes[at] ?? 0) <= NINE;
  const first = sign();
  let [value, digits, power] = [0, 0, 0];
  for (; isDigit(); at++, digits++) value = 10 * value + (bytes[at] ?? 0) - ZERO;
  if (bytes[at] === point) for (at++; isDigit(); at++, digits++, power--) value = 10 * value + (bytes[at] ?? 0) - ZERO;
  if (digits === 0) return undefined;
  if (at < to && (bytes[at] === LOWER_E || bytes[at] === UPPER_E)) {
    at++;
    const direction = sign();
    let exponent = 0;
    for (; isDigit(); at++) exponent = 10 * exponent + (bytes[at] ?? 0) - ZERO;
    power += direction * exponent;
  }
  const size = power < 0 ? value / 10 ** -power : value * 10 ** power;
  return at === to && Number.isFinite(size) ? first * size : undefined;
}

/** The number in these bytes; NaN if it is a hole. */
function cell(bytes: Uint8Array, from: number, to: number, hasCommas: boolean): number {
  const isPadding = (byte: number | undefined) => byte === SPACE || byte === TAB || byte === RETURN || byte === QUOTE;
  while (from < to && isPadding(bytes[from])) from++;
  while (to > from && isPadding(bytes[to - 1])) to--;
  if (from === to) return NaN;
  const found = decimal(bytes, from, to, hasCommas ? COMMA : POINT);
  if (found !== undefined) return found;
  const word = String.fromCharCode(...bytes.subarray(from, Math.min(to, from + 64)));
  if (isHole(word)) return NaN;
  const value = numberOf(hasCommas ? word.replace(",", ".") : word);
  if (value === undefined) throw badFile(`its table has ${JSON.stringify(word.slice(0, 20))} where a number is needed`);
  return value;
}

/** Calls `put` with the bounds of each cell of a line; returns the number of cells. */
function eachCell(bytes: Uint8Array, from: number, to: number, separator: number, put: (a: number, b: number) => void) {
  let count = 0;
  if (separator !== SPACE) {
    for (let start = from; start <= to; count++) {
      const next = bytes.indexOf(separator, start);
      const end = next < 0 || next > to ? to : next;
      put(start, end);
      start = end + 1;
    }
    return count;
  }
  const isBlank = (byte = 0) => byte <= SPACE;
  for (let at = from; at < to; ) {
    while (at < to && isBlank(bytes[at])) at++;
    const start = at;
    while (at < to && !isBlank(bytes[at])) at++;
    if (at > start) {
      put(start, at);
      count++;
    }
  }
  return count;
}

/** Whether numbers are 0, 1, 2 and so on, as pandas names rows and columns. */
function counts(values: ArrayLike<number>, length: number, from = 0, step = 1): boolean {
  for (let at = 0; at < length; at++) if (values[from + step * at] !== at) return false;
  return length > 1;
}

interface Cells {
  values: Float64Array;
  width: number;
  height: number;
}

const BOM = [0xef, 0xbb, 0xbf];

/** Whether a line is empty or a comment; a line of only tabs is a row of holes. */
function isLeftOut(bytes: Uint8Array, from: number, to: number, separator: number): boolean {
  let at = from;
  while (at < to && (bytes[at] === SPACE || (bytes[at] === TAB && separator !== TAB))) at++;
  return at >= to || isComment(String.fromCharCode(...bytes.subarray(at, Math.min(at + 2, to))));
}

/** All cells, row by row, without a first row of words. */
function cellsOf(bytes: Uint8Array): Cells {
  const { rows, separator, isTrailing } = headOf(bytes);
  const [code, hasCommas] = [separator.charCodeAt(0), separator === ";"];
  let isFirst = rows[0] !== undefined && !isNumbers(rows[0]);
  const values = new Float64Array(Math.min(MOST_CELLS, bytes.length));
  let [count, width, height] = [0, 0, 0];
  for (let at = BOM.every((byte, index) => bytes[index] === byte) ? BOM.length : 0; at < bytes.length; ) {
    const newline = bytes.indexOf(NEWLINE, at);
    const end = newline < 0 ? bytes.length : newline;
    const [from, to] = [at, bytes[end - 1] === RETURN ? end - 1 : end];
    at = end + 1;
    if (isLeftOut(bytes, from, to, code)) continue;
    if (isFirst) {
      isFirst = false;
      continue;
    }
    const until = isTrailing && bytes[to - 1] === code ? to - 1 : to;
    const cells = eachCell(bytes, from, until, code, (a, b) => {
      if (count === values.length)
        throw badFile("its table has more numbers than 1920x1080 pixels; save it as 16-bit PNG or .npy");
      values[count++] = cell(bytes, a, b, hasCommas);
    });
    if (height++ === 0) width = cells;
    if (cells !== width)
      throw badFile(`its table has ${cells} columns in row ${height}, but ${width} in the rows before`);
  }
  return { values: values.subarray(0, count), width, height };
}

/** The cells without the names of rows and columns. */
function unnamed({ values, width, height }: Cells): Cells {
  const top = counts(values, width) || counts(values, width - 1, 1) ? 1 : 0;
  const left = counts(values, height - top, top * width, width) ? 1 : 0;
  if (top + left === 0) return { values, width, height };
  const kept = { width: width - left, height: height - top };
  const all = Float64Array.from({ length: kept.width * kept.height }, (_, at) => {
    const [row, column] = [Math.floor(at / kept.width), at % kept.width];
    return values[(row + top) * width + column + left] ?? NaN;
  });
  return { values: all, ...kept };
}

/** A table as a raster; cells that are empty, NaN or infinite are holes. */
export function readTable(bytes: Uint8Array): Picture {
  const { values, width, height } = unnamed(cellsOf(bytes));
  checkSize(width, height);
  return { width, height, channels: 1, ...levels(values), format: "table", notes: ["a table as text"], warnings: [] };
}

/** The values in 16 bits, as depth cameras write them, if all are integers of this range, or else as floats. */
function levels(values: Float64Array): Pick<Picture, "data" | "bits"> {
  const isLevel = (value: number) => Number.isNaN(value) || (Number.isInteger(value) && value <= 0xffff);
  if (values.every(isLevel)) return { data: Uint16Array.from(values, (value) => Math.max(0, value || 0)), bits: 16 };
  return { data: new Float32Array(values), bits: 32 };
}
