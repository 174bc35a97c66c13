/** Points as text, one per line: XYZ, ASC, PTS and CSV, with or without a line of column names. */
import { badFile } from "../../errors.js";
import { FEWEST_POINTS, channelOf, roomFor } from "./channels.js";
import { checkPoints } from "./grid.js";
import type { Points } from "./picture.js";
import { headOf, isNumbers, wordsOf } from "./table.js";

/** The columns of x, y, z, and the names of all columns. */
function columnsOf(names: string[] | undefined, count: number): { axes: number[]; others: (string | undefined)[] } {
  if (names === undefined) return { axes: [0, 1, 2], others: count === 4 ? ["x", "y", "z", "intensity"] : [] };
  const plain = names.map((name) =>
    name
      .replace(/^\/+/, "")
      .replace(/\s*\[.*\]$|^scalar_/gi, "")
      .toLowerCase(),
  );
  const axes = ["x", "y", "z"].map((axis) =>
    plain.findIndex((name) => name === axis || name === `${axis}(m)` || name === `${axis}_m`),
  );
  return { axes, others: plain };
}

/** The points of a text whose first lines are a list of points; undefined where it is too short or lacks x, y or z. */
export function readXyz(bytes: Uint8Array): Points | undefined {
  const { rows, separator } = headOf(bytes);
  const isCounted = rows[0]?.length === 1;
  const names = !isCounted && rows[0] !== undefined && !isNumbers(rows[0]) ? rows[0] : undefined;
  const count = (rows[1] ?? []).length;
  const { axes, others } = columnsOf(names, count);
  if (axes.includes(-1) || count < 3) return undefined;
  const lines = new TextDecoder("latin1")
    .decode(bytes)
    .split(/\r?\n/)
    .filter((line) => line.trim() !== "" && !/^\s*[#%]/.test(line));
  if (isCounted || names) lines.shift();
  if (lines.length < FEWEST_POINTS) return undefined;
  checkPoints(lines.length);
  const channels = others.map((name) => (name === undefined ? undefined : channelOf(name)));
  const scan = { points: new Float32Array(3 * lines.length), ...roomFor(lines.length, channels) };
  lines.forEach((line, point) => {
    const values = wordsOf(line, separator).map(Number);
    axes.forEach((column, axis) => {
      const value = values[column];
      if (value === undefined) throw badFile(`it has no x, y and z in line ${point + 1} of its points`);
      scan.points[3 * point + axis] = value;
    });
    channels.forEach((channel, column) => {
      const into = channel && scan[channel];
      if (into) into[point] = values[column] ?? NaN;
    });
  });
  return { format: "a list of points", scan, isMetric: scan.ring !== undefined, notes: [], warnings: [] };
}
