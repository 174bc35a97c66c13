/** Points as text, one per line: XYZ, ASC, PTS and CSV, with or without a line of column names. */
import { badFile } from "../../errors.js";
import { FEWEST_POINTS, channelOf, roomFor } from "./channels.js";
import { checkPoints } from "./grid.js";
import type { Points } from "./picture.js";
import { type PointColumns, pointColumns } from "./point-list.js";
import { headOf, isComment, isNumbers, wordsOf } from "./table.js";

/** The contents of columns without names, by their number. */
const unnamed = (count: number): PointColumns => ({
  axes: [0, 1, 2],
  names: count === 4 ? ["x", "y", "z", "intensity"] : [],
});

/** The points of a text whose first lines are a list of points; undefined where it is too short or lacks x, y or z. */
export function readXyz(bytes: Uint8Array): Points | undefined {
  const { rows, separator } = headOf(bytes);
  const isCounted = rows[0]?.length === 1;
  const names = !isCounted && rows[0] !== undefined && !isNumbers(rows[0]) ? rows[0] : undefined;
  const count = (rows[1] ?? []).length;
  const columns = names ? pointColumns(names) : unnamed(count);
  if (columns === undefined || count < 3) return undefined;
  const { axes, unit } = columns;
  const lines = new TextDecoder("latin1")
    .decode(bytes)
    .split(/\r?\n/)
    .filter((line) => !isComment(line));
  if (isCounted || names) lines.shift();
  if (lines.length < FEWEST_POINTS) return undefined;
  checkPoints(lines.length);
  const channels = columns.names.map(channelOf);
  const scan = { points: new Float32Array(3 * lines.length), ...roomFor(lines.length, channels) };
  lines.forEach((line, point) => {
    const values = wordsOf(line, separator).map(Number);
    axes.forEach((column, axis) => {
      const value = values[column];
      if (value === undefined) throw badFile(`it has no x, y and z in line ${point + 1} of its points`);
      scan.points[3 * point + axis] = value * (unit ?? 1);
    });
    channels.forEach((channel, column) => {
      const into = channel && scan[channel];
      if (into) into[point] = values[column] ?? NaN;
    });
  });
  return {
    format: "a list of points",
    scan,
    isMetric: unit !== undefined || scan.ring !== undefined,
    notes: [],
    warnings: [],
  };
}
