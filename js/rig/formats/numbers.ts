/** Numbers and matrices as the many files write them. */

export type Numbers = number[];
export type Node = Record<string, unknown>;

export const isNode = (value: unknown): value is Node =>
  typeof value === "object" && value !== null && !Array.isArray(value);

// One way to match any digits: two would be tried against each other, for minutes where there are many.
const NUMBER = /^[-+]?(?:\d+(?:\.\d*)?|\.\d+)(?:[eEdD][-+]?\d+)?$/;
/** Calibrations have matrices of 16 numbers, distortions of 14; more than this is something else. */
const MOST = 64;

/** A number, also one that is written as text; nothing where it is none or not finite. */
export function numberOf(value: unknown): number | undefined {
  if (typeof value === "number") return Number.isFinite(value) ? value : undefined;
  if (typeof value !== "string" || !NUMBER.test(value.trim())) return undefined;
  return Number(value.trim().replace(/[dD]/, "e"));
}

export interface Matrix {
  values: Numbers;
  /** Rows where the file says them: lists of lists, `rows`. */
  rows?: number;
}

function listOf(value: unknown): Numbers | undefined {
  const parts = typeof value === "string" ? value.split(/[\s,;[\]()]+/, MOST + 2).filter((part) => part !== "") : value;
  if (!Array.isArray(parts) || parts.length === 0 || parts.length > MOST) return undefined;
  const numbers = parts.map(numberOf);
  return numbers.every((number) => number !== undefined) ? numbers : undefined;
}

/** The columns of a square matrix, as Apple's simd has them. */
function ofColumns(columns: unknown[]): Matrix | undefined {
  const side = columns.length;
  const values = columns.flatMap((column) => listOf(column) ?? []);
  return values.length === side * side && side > 1 ? { values: transposed(values, side), rows: side } : undefined;
}

/** A list of numbers, of lists of numbers, or { rows, cols, data } of OpenCV and ROS, or of OpenCalib, whose data are rows. */
export function matrixOf(value: unknown): Matrix | undefined {
  if (isNode(value)) {
    if (Array.isArray(value.columns)) return ofColumns(value.columns);
    const nested = Array.isArray(value.data) && value.data.every(Array.isArray);
    const values = listOf(nested && Array.isArray(value.data) ? value.data.flat() : value.data);
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
