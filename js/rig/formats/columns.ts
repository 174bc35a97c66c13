/** Tables of numbers under a line of names: roll, pitch, yaw, x, y, z, or time, x, y, z, qx, qy, qz, qw. */
import { badFile } from "../../errors.js";
import { type Node, numberOf } from "./numbers.js";

const MOST_ROWS = 20_000;
const NAME = /^[A-Za-z_][\w .()/[\]-]{0,40}$/;
const TIME = /^(?:#?\s*)?(?:time|timestamp|stamp|t|frame|image|index|id|file|filename)\b/i;

const cells = (line: string): string[] =>
  line
    .replace(/^#\s*/, "")
    .split(/[,;\t]/)
    .map((cell) => cell.trim().replace(/^"(.*)"$/, "$1"));

/** The rows by the names of their columns; undefined where a text is not such a table. `isSeries`: each row has a time or an image. */
export function readColumns(text: string): { rows: Node[]; isSeries: boolean } | undefined {
  const lines = text.split(/\r?\n/).filter((line) => line.trim() !== "");
  const names = cells(lines[0] ?? "").map((name) => name.replace(/\s*[[(].*$/, ""));
  if (lines.length < 2 || names.length < 4 || !names.every((name) => NAME.test(name))) return undefined;
  const rows = lines.slice(1, MOST_ROWS + 2).map(cells);
  if (rows.length > MOST_ROWS) throw badFile(`it is a table of more than ${MOST_ROWS} rows`);
  const isRow = (row: string[]) =>
    row.length === names.length && row.filter((cell) => numberOf(cell) !== undefined).length >= 3;
  if (!rows.every(isRow)) return undefined;
  const isSeries = names.some((name) => TIME.test(name));
  return { rows: rows.map((row) => Object.fromEntries(names.map((name, at) => [name, row[at]]))), isSeries };
}
