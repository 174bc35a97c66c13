/** Reads numbers and matrices in the many forms in which files write them. */

export type Numbers = number[];
export type Node = Record<string, unknown>;

export const isNode = (value: unknown): value is Node =>
  typeof value === "object" && value !== null && !Array.isArray(value);

// The pattern matches any digits in only one way; with two ways, a long run of digits would take minutes.
const NUMBER = /^[-+]?(?:\d+(?:\.\d*)?|\.\d+)(?:[eEdD][-+]?\d+)?$/;
/** Largest number of numbers in a list; calibrations have matrices of 16 and distortions of 14. */
const MOST = 64;
/** Largest number of names in a text of numbers. */
const MOST_NAMES = 400;
const LONGEST_TEXT = 200;

/** A finite number, which may be written as text. */
export function numberOf(value: unknown): number | undefined {
  if (typeof value === "number") return Number.isFinite(value) ? value : undefined;
  if (typeof value !== "string" || !NUMBER.test(value.trim())) return undefined;
  return Number(value.trim().replace(/[dD]/, "e"));
}

/** The numbers of some members; NaN where one is missing. */
export const numbersAt = (node: Node, keys: readonly string[]): Numbers =>
  keys.map((key) => numberOf(node[key]) ?? NaN);

/** The objects of a list. */
export const nodesOf = (value: unknown): Node[] => (Array.isArray(value) ? value.filter(isNode) : []);

/** A text that is not empty, cut to the length of a name. */
export const textOf = (value: unknown): string | undefined =>
  typeof value === "string" && value !== "" ? value.slice(0, LONGEST_TEXT) : undefined;

/** Lines that consist of a name and numbers, by their names; `line` matches the name and the rest. */
export function numbersByName(text: string, line: RegExp): Map<string, Numbers> {
  const found = new Map<string, Numbers>();
  for (const each of text.split(/\r?\n/)) {
    const [, key, rest = ""] = line.exec(each) ?? [];
    const numbers = rest.trim().split(/\s+/, 20).map(numberOf);
    if (found.size >= MOST_NAMES) break;
    if (key !== undefined && numbers.every((number) => number !== undefined)) found.set(key, numbers);
  }
  return found;
}

export interface Matrix {
  values: Numbers;
  /** The number of rows, if the file has a list of rows or the member `rows`. */
  rows?: number;
}

function listOf(value: unknown): Numbers | undefined {
  const parts = typeof value === "string" ? value.split(/[\s,;[\]()]+/, MOST + 2).filter((part) => part !== "") : value;
  if (!Array.isArray(parts) || parts.length === 0 || parts.length > MOST) return undefined;
  const numbers = parts.map(numberOf);
  return numbers.every((number) => number !== undefined) ? numbers : undefined;
}

/** Reads a square matrix from its columns, as Apple's simd stores it. */
function ofColumns(columns: unknown[]): Matrix | undefined {
  const side = columns.length;
  const values = columns.flatMap((column) => listOf(column) ?? []);
  return values.length === side * side && side > 1 ? { values: transposed(values, side), rows: side } : undefined;
}

/** A list of numbers, a list of rows, or { rows, cols, data } of OpenCV, ROS and OpenCalib, whose data may be rows. */
export function matrixOf(value: unknown): Matrix | undefined {
  if (isNode(value)) {
    if (Array.isArray(value.columns)) return ofColumns(value.columns);
    const { data } = value;
    const values = listOf(Array.isArray(data) && data.every(Array.isArray) ? data.flat() : data);
    const [rows, columns] = [numberOf(value.rows), numberOf(value.cols)];
    if (values === undefined || rows === undefined || columns === undefined || rows * columns !== values.length)
      return undefined;
    return { values, rows };
  }
  if (Array.isArray(value) && value.length > 0 && value.length <= MOST && value.every(Array.isArray)) {
    const rows = value.map(listOf);
    const width = rows[0]?.length;
    if (!rows.every((row) => row !== undefined && row.length === width)) return undefined;
    return { values: rows.flatMap((row) => row ?? []), rows: rows.length };
  }
  const values = listOf(value);
  return values && { values };
}

export const transposed = (values: Numbers, side: number): Numbers =>
  values.map((_, at) => values[(at % side) * side + Math.floor(at / side)] ?? 0);
