// Formats figures as words and words as columns.
import { isConfidentlyWrong, isFlagged } from "../../protocols/counts.mjs";

export const DASH = "-";
export const fixed = (value, digits = 3) =>
  typeof value === "number" && Number.isFinite(value) ? value.toFixed(digits) : DASH;
export const percent = (value) => (typeof value === "number" ? `${(100 * value).toFixed(0)} %` : DASH);
/** The mark of a pose: "?" if it is flagged as uncertain, "!" if it is wrong by more than 3 degrees without a flag. */
export const mark = (row) => (isFlagged(row) ? "?" : isConfidentlyWrong(row) ? "!" : "");

/** Lists of words as columns, the first one left-aligned. */
export function columns(rows) {
  const widths = rows[0].map((_, column) => Math.max(...rows.map((row) => String(row[column]).length)));
  const pad = (word, column) => (column === 0 ? String(word).padEnd(widths[0]) : String(word).padStart(widths[column]));
  return rows.map((row) => `  ${row.map(pad).join("  ")}`.trimEnd());
}

export const unique = (values) => [...new Set(values)];
