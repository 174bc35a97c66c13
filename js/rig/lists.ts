/** Frames named by lists: TUM's rgb.txt and depth.txt, or one list of associations, each with time stamps. */
import { badFile } from "../errors.js";
import { textOf } from "./formats/decode.js";
import { base, folderOf } from "./names.js";
import { roleOf } from "./roles.js";
import type { NamedFile } from "./types.js";
import { type ReaderWarning, warning } from "./warnings.js";

export interface Pair {
  name: string;
  colour: NamedFile;
  /** The depth map, in one or more files; the first one that can be read is used. */
  depths: [NamedFile, ...NamedFile[]];
  mask?: NamedFile;
}

export interface Pairs {
  pairs: Pair[];
  /** Metres per unit of such folders, unless another unit is stated. */
  supposed?: number;
  says: string;
}

/** Time stamps farther apart than this, in seconds, are not a pair; TUM's own tool has the same limit. */
export const APART = 0.02;
const TUM_UNIT = 1 / 5000;
/** Largest number of lines in a list of frames. */
const MOST_LINES = 200_000;

export interface Stamp {
  time: number;
  path: string;
}

const linesOf = (file: NamedFile): string[] => {
  const lines = (textOf(file.bytes) ?? "")
    .split(/\r?\n/)
    .filter((line) => line.trim() !== "" && !line.trim().startsWith("#"));
  if (lines.length > MOST_LINES) throw badFile(`${file.name}: it lists more than ${MOST_LINES} frames`);
  return lines;
};

/** A time stamp and a path on each line. */
const listed = (file: NamedFile): Stamp[] =>
  linesOf(file).map((line) => {
    const [time = "", path = ""] = line.trim().split(/\s+/);
    if (path === "" || !Number.isFinite(Number(time)))
      throw badFile(
        `${file.name}: it lists time stamps and files, and ${JSON.stringify(line.slice(0, 60))} is neither`,
      );
    return { time: Number(time), path };
  });

/** Pairs the items of two lists that are nearest in time. Returns both items and the time of the first. */
export function byTime(colours: Stamp[], depths: Stamp[], apart = APART): [string, string, number][] {
  const order = [...depths].sort((a, b) => a.time - b.time);
  const found: [string, string, number][] = [];
  let from = 0;
  for (const { time, path } of [...colours].sort((a, b) => a.time - b.time)) {
    while (
      from + 1 < order.length &&
      Math.abs((order[from + 1]?.time ?? 0) - time) <= Math.abs((order[from]?.time ?? 0) - time)
    )
      from++;
    const nearest = order[from];
    if (nearest === undefined || Math.abs(nearest.time - time) > apart) continue;
    found.push([path, nearest.path, time]);
    from++;
  }
  return found;
}

/** "time path time path", with the two in either order; undefined if a line has another form. */
function associated(file: NamedFile): [string, string, number][] | undefined {
  const found: [string, string, number][] = [];
  for (const line of linesOf(file)) {
    const [time = "", one = "", , other = ""] = line.trim().split(/\s+/);
    if (other === "" || !Number.isFinite(Number(time))) return undefined;
    found.push(roleOf(one) === "depth" ? [other, one, Number(time)] : [one, other, Number(time)]);
  }
  return found.length > 0 ? found : undefined;
}

/** The frames of a folder with TUM's lists, or undefined. */
export function tum(files: NamedFile[], warnings: ReaderWarning[]): Pairs | undefined {
  const list = (pattern: RegExp) => files.find((file) => pattern.test(base(file.name)));
  const [colours, depths] = [list(/^rgb\.txt$/i), list(/^depth\.txt$/i)];
  const both = colours === undefined || depths === undefined ? list(/^associat\w*\.txt$/i) : undefined;
  const first = colours && depths ? colours : both;
  if (first === undefined) return undefined;
  const found = colours && depths ? byTime(listed(colours), listed(depths)) : both && associated(both);
  if (found === undefined) return undefined;
  if (found.length === 0 && depths)
    throw badFile(`${first.name}: none of its time stamps lies within ${1000 * APART} ms of one in ${depths.name}`);
  const names = both ? base(both.name) : "rgb.txt and depth.txt";
  const pairs = presentOf(found, { root: folderOf(first.name), files, names }, warnings);
  return { pairs, supposed: TUM_UNIT, says: `TUM RGB-D, ${pairs.length} pairs within ${1000 * APART} ms` };
}

interface Place {
  root: string;
  files: NamedFile[];
  names: string;
}

/** The listed pairs whose files exist. */
function presentOf(
  found: [string, string, number][],
  { root, files, names }: Place,
  warnings: ReaderWarning[],
): Pair[] {
  const byPath = new Map(files.map((file) => [file.name, file]));
  const pairs = found.flatMap(([colourPath, depthPath, time]) => {
    const [colour, depth] = [byPath.get(root + colourPath), byPath.get(root + depthPath)];
    return colour && depth ? [{ name: String(time), colour, depths: [depth] as [NamedFile] }] : [];
  });
  const missing = found.length - pairs.length;
  if (missing > 0)
    warnings.push(
      warning("pairs-missing", `${missing} of the ${found.length} pairs that ${names} list are not in the folder.`, {
        missing,
        listed: found.length,
      }),
    );
  return pairs;
}
