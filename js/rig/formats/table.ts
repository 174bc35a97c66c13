/**
 * Texts that are tables of numbers: a depth map row by row (CSV, TXT of numpy.savetxt or MATLAB). Lists of points are in point-list.ts.
 *
 * The size distinguishes a depth map from matrices and trajectories. Limits: all rows of a table need the same number of columns.
 */
import { numberOf } from "./numbers.js";
import { MOST_SIDE } from "./limits.js";

/** Size of the smallest depth map; matrices and trajectories have fewer columns or rows. */
const [FEWEST_COLUMNS, FEWEST_ROWS] = [24, 18];
/** Smallest share of the first rows that must have as many numbers as the first one. */
const MOSTLY = 0.9;
/** Largest number of lines that are examined to recognise a text. */
const HEAD = 40;
/** Largest number of characters of these lines. */
const HEAD_CHARACTERS = 2 ** 19;

export const isComment = (line: string): boolean => /^\s*(?:[#%]|\/\/|$)/.test(line);
export const isHole = (word: string): boolean => /^[-+]?(?:nan|inf|infinity|none|null|na)?$/i.test(word);

/** The separator of the words of a line; if semicolons separate them, a comma is decimal. */
const separatorOf = (line: string): string => [";", ",", "\t"].find((each) => line.includes(each)) ?? " ";

export function wordsOf(line: string, separator: string): string[] {
  const words = separator === " " ? line.trim().split(/\s+/) : line.split(separator);
  return words.map((word) =>
    word
      .trim()
      .replace(/^"(.*)"$/, "$1")
      .replace(separator === ";" ? "," : "\0", "."),
  );
}

export const isNumbers = (words: string[]): boolean =>
  words.every((word) => isHole(word) || numberOf(word) !== undefined);

interface Head {
  rows: string[][];
  separator: string;
  /** Whether lines end in the separator, so that an empty last word is not a hole. */
  isTrailing: boolean;
}

/** The words of the first lines that are not comments. */
export function headOf(bytes: Uint8Array): Head {
  const text = new TextDecoder("latin1").decode(bytes.subarray(0, HEAD_CHARACTERS)).replace(/^ï»¿/, "");
  const lines = text.split(/\r?\n/, HEAD);
  // The last line may be cut off.
  if (bytes.length > HEAD_CHARACTERS && lines.length > 1 && lines.length < HEAD) lines.pop();
  const used = lines.filter((line) => !isComment(line));
  const separator = separatorOf(used[1] ?? used[0] ?? "");
  const rows = used.map((line) => wordsOf(line, separator));
  const isTrailing = rows.length > 0 && rows.filter((row) => row.at(-1) === "").length >= MOSTLY * rows.length;
  const ofRow = (row: string[]) => (isTrailing && row.at(-1) === "" ? row.slice(0, -1) : row);
  return { rows: rows.map(ofRow), separator, isTrailing };
}

/** Whether the first lines of a text are rows with equally many numbers, at the size of a depth map. */
export function isTable(bytes: Uint8Array): boolean {
  const { rows } = headOf(bytes);
  // The first row may name the columns.
  const [first, ...others] = rows[0] !== undefined && isNumbers(rows[0]) ? rows : rows.slice(1);
  if (first === undefined || first.length < FEWEST_COLUMNS || first.length > MOST_SIDE + 1) return false;
  // A damaged row is reported when the table is read.
  const alike = others.filter((row) => row.length === first.length && isNumbers(row));
  return rows.length >= FEWEST_ROWS && alike.length >= MOSTLY * others.length;
}
