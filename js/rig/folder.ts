/**
 * Whole folders: frames paired by time stamps (TUM RGB-D) or by like names (Redwood's and Open3D's color/ and depth/, 7-Scenes' and other
 * name schemes), with the cameras and poses that lie beside them.
 *
 * A file that cannot be read costs its frame, not the folder: it is named in `warnings`.
 */
import { breathe } from "../breathe.js";
import { type Check, object, signal, wrong } from "../check.js";
import { BimodalError, badFile, refused } from "../errors.js";
import { addCameras } from "./assign.js";
import { textOf } from "./formats/text.js";
import { checkNamed, isRasterFile, metresPerUnit, readRigFile } from "./read.js";
import type { CheckFrame, Mask, NamedFile, ReadOptions, Reading, RigFolder, RigReading } from "./types.js";
import { type ReaderWarning, grouped, ofFile, warning } from "./warnings.js";

/** How `readRigFolder` reads. */
export interface FolderOptions {
  /** Metres per stored unit of all depth maps. */
  unit?: number;
  /** At most so many pairs are read, evenly spread over the folder; default 20. */
  frames?: number;
  /** Breaks the reading off between two files; the promise is rejected with its reason. */
  signal?: AbortSignal;
}

const FRAMES = 20;
/** Time stamps farther apart than this, in seconds, are no pair; TUM's own tool has the same. */
const APART = 0.02;
const TUM_UNIT = 1 / 5000;
/** Lines of a list of frames. */
const MOST_LINES = 200_000;

const DEPTH = /depth|dpt|range(?![a-z])|disp/i;
const MASK = /mask|segm/i;
const COLOUR = /colou?r|rgb|image|img/i;
const IGNORED =
  /(^|\/)(\.|__MACOSX|thumbs\.db|readme|licen[cs]e|copying|source\.txt|changelog)|\.(md|html?|py|mjs|js|csv|bag|mp4|avi|klg)$/i;
/** A path that leads out of the folder is that of a file which somebody named. */
const ELSEWHERE = /^(?:\/|\.\.\/|[a-z]:\/)/i;
const LISTS = /(^|\/)(rgb|depth|associat\w*|accelerometer|groundtruth|times?(tamps)?)\.(txt|csv)$/i;

const base = (name: string): string => name.slice(name.lastIndexOf("/") + 1);
const stem = (name: string): string => base(name).replace(/\.[a-z0-9]{1,5}$/i, "");

interface Pair {
  name: string;
  colour: NamedFile;
  depth: NamedFile;
  mask?: NamedFile;
}

interface Pairs {
  pairs: Pair[];
  unit?: number;
  says: string;
}

/** A name without what says which file of a frame it is. */
const common = (name: string): string =>
  name.normalize("NFC").replace(/depth|dpt|colou?r|rgb|image|img|mask|crop|registered|aligned/gi, " ");
/** Of a file with its folders. */
const commonPath = (name: string): string => common(name.slice(0, name.length - base(name).length) + stem(name));

/** What files of one frame have in common: letters of any script, in either case, and numbers without leading zeros. */
function key(name: string): string {
  const words = common(stem(name))
    .toLowerCase()
    .split(/[^\p{L}\p{M}\p{N}.]+/u)
    .map((word) => word.replace(/^\.+|\.+$/g, "").replace(/^0+(?=\d)/, ""));
  return words.filter((word) => word !== "" && word !== "mm").join(" ");
}

/** TUM's lists: a time stamp and a path on each line. */
function listed(file: NamedFile): { time: number; path: string }[] {
  const lines = (textOf(file.bytes) ?? "")
    .split(/\r?\n/)
    .filter((line) => line.trim() !== "" && !line.trim().startsWith("#"));
  if (lines.length > MOST_LINES) throw badFile(`${file.name}: it lists more than ${MOST_LINES} frames`);
  return lines.map((line) => {
    const [time = "", path = ""] = line.trim().split(/\s+/);
    if (path === "" || !Number.isFinite(Number(time)))
      throw badFile(
        `${file.name}: it lists time stamps and files, and ${JSON.stringify(line.slice(0, 60))} is neither`,
      );
    return { time: Number(time), path };
  });
}

/** Of two lists in order of time, those nearest to each other. */
function byTime(
  colours: { time: number; path: string }[],
  depths: { time: number; path: string }[],
): [string, string, number][] {
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
    if (nearest === undefined || Math.abs(nearest.time - time) > APART) continue;
    found.push([path, nearest.path, time]);
    from++;
  }
  return found;
}

function tum(files: NamedFile[], warnings: ReaderWarning[]): Pairs | undefined {
  const list = (name: string) => files.find((file) => base(file.name).toLowerCase() === name);
  const [colours, depths] = [list("rgb.txt"), list("depth.txt")];
  if (colours === undefined || depths === undefined) return undefined;
  const found = byTime(listed(colours), listed(depths));
  const byPath = new Map(files.map((file) => [file.name, file]));
  const root = colours.name.slice(0, colours.name.length - base(colours.name).length);
  const pairs: Pair[] = [];
  let missing = 0;
  for (const [colourPath, depthPath, time] of found) {
    const [colour, depth] = [byPath.get(root + colourPath), byPath.get(root + depthPath)];
    if (colour && depth) pairs.push({ name: String(time), colour, depth });
    else missing++;
  }
  if (missing > 0)
    warnings.push(
      warning(
        "pairs-missing",
        `${missing} of the ${found.length} pairs that rgb.txt and depth.txt list are not in the folder.`,
        { missing, listed: found.length },
      ),
    );
  if (found.length === 0)
    throw badFile(`${colours.name}: no time stamp of it lies within ${1000 * APART} ms of one of ${depths.name}`);
  return { pairs, unit: TUM_UNIT, says: `TUM RGB-D, ${pairs.length} pairs within ${1000 * APART} ms` };
}

function byKey(files: NamedFile[]): Map<string, NamedFile[]> {
  const groups = new Map<string, NamedFile[]>();
  for (const file of files) {
    const group = groups.get(key(file.name));
    if (group) group.push(file);
    else groups.set(key(file.name), [file]);
  }
  return groups;
}

/** By like names; where those differ throughout, in their order. */
function byNames(pictures: NamedFile[], warnings: ReaderWarning[]): Pairs {
  const isDepth = (file: NamedFile) =>
    DEPTH.test(base(file.name)) || (DEPTH.test(file.name) && !COLOUR.test(base(file.name)));
  const masks = pictures.filter((file) => MASK.test(file.name));
  const others = pictures.filter((file) => !MASK.test(file.name));
  const depths = others.filter(isDepth);
  const colours = others.filter((file) => !isDepth(file));
  const maskOf = (name: string) =>
    masks.find((mask) => key(mask.name) === name) ??
    (masks.length === 1 && key(masks[0]?.name ?? "") === "" ? masks[0] : undefined);
  const pair = (name: string, colour: NamedFile, depth: NamedFile): Pair => {
    const mask = maskOf(name);
    return { name, colour, depth, ...(mask && { mask }) };
  };
  const likeColours = byKey(colours);
  /** Files of which that is said already. */
  const ambiguous = new Set<string>();
  const pairs = [...byKey(depths)].flatMap(([name, likeDepths]) => {
    const theirs = likeColours.get(name) ?? [];
    const isClear = theirs.length === 1 && likeDepths.length === 1;
    return likeDepths.flatMap((depth) => {
      // Names that differ in case and signs alone belong together where all the rest of their paths agrees.
      const [colour, ...others] = isClear
        ? theirs
        : theirs.filter((file) => commonPath(file.name) === commonPath(depth.name));
      if (colour && others.length === 0) return [pair(name, colour, depth)];
      if (theirs.length > 0) {
        warnings.push(
          ofFile(depth.name, warning("names-ambiguous", "several files have names like this one; it was left out.")),
        );
        for (const { name } of [depth, ...theirs]) ambiguous.add(name);
      }
      return [];
    });
  });
  if (pairs.length > 0) {
    const said = new Set([...pairs.flatMap(({ colour, depth }) => [colour.name, depth.name]), ...ambiguous]);
    for (const { name } of others)
      if (!said.has(name))
        warnings.push(ofFile(name, warning("file-alone", "no other file's name fits it alone (left out).")));
    return { pairs, says: `${pairs.length} pairs by their names` };
  }
  if (depths.length === 0 || depths.length !== colours.length) return { pairs: [], says: "" };
  const inOrder = (files: NamedFile[]) =>
    [...files].sort((a, b) => a.name.localeCompare(b.name, "en", { numeric: true }));
  if (depths.length > 1)
    warnings.push(
      warning(
        "pairs-by-order",
        `No depth map has a name like a colour image's; the ${depths.length} of each were paired in the order of their names.`,
        { pairs: depths.length },
      ),
    );
  const ordered = inOrder(colours);
  return {
    pairs: inOrder(depths).flatMap((depth, index) =>
      ordered[index] ? [pair(key(depth.name), ordered[index], depth)] : [],
    ),
    says: `${depths.length} pairs in their order`,
  };
}

/** Evenly spread, the first and the last among them. */
function spread<T>(all: T[], most: number): T[] {
  if (all.length <= most) return all;
  return Array.from(
    { length: most },
    (_, index) => all[most === 1 ? 0 : Math.round((index * (all.length - 1)) / (most - 1))] as T,
  );
}

class FolderReader {
  readonly readings: Reading[] = [];
  readonly warnings: ReaderWarning[] = [];
  readonly #signal: AbortSignal | undefined;

  constructor(signal: AbortSignal | undefined) {
    this.#signal = signal;
  }

  /** Lets events pass, an abort among them. */
  async rest(): Promise<void> {
    await breathe();
    this.#signal?.throwIfAborted();
  }

  /** The file's content, or nothing with a warning. */
  async read(file: NamedFile, options: ReadOptions): Promise<RigReading | undefined> {
    await this.rest();
    try {
      const found = await readRigFile(file, options);
      this.readings.push({ name: found.name, says: found.says, warnings: found.warnings });
      for (const each of found.warnings) this.warnings.push(ofFile(file.name, each));
      return found;
    } catch (error) {
      if (!(error instanceof BimodalError)) throw error;
      const message = `${error.message} (left out)`;
      this.warnings.push({ ...warning("file-left-out", message, { ...error.details }), file: file.name });
      return undefined;
    }
  }

  async frame({ name, colour, depth, mask }: Pair, unit: number | undefined): Promise<CheckFrame | undefined> {
    const image = await this.read(colour, { as: "colour" });
    const map = await this.read(depth, { as: "depth", ...(unit !== undefined && { unit }) });
    if (image?.kind !== "colour" || map?.kind !== "depth") return undefined;
    const masked = mask && (await this.read(mask, { as: "mask" }));
    const frame = { image: image.image, depth: map.depth, name: name === "" ? stem(colour.name) : name };
    if (masked?.kind === "mask") this.#mask(frame, masked.mask, masked.name);
    return frame;
  }

  #mask({ image, depth }: CheckFrame, { width, height, data }: Mask, name: string): void {
    if (image.width === width && image.height === height) image.mask = data;
    else if (depth.width === width && depth.height === height) depth.mask = data;
    else
      this.warnings.push(
        ofFile(
          name,
          warning("mask-size", `the mask is ${width}x${height}, the size of neither picture; it was left out.`),
        ),
      );
  }
}

/** Guessed for each depth map by itself, units have to agree. */
function checkUnits(frames: CheckFrame[], warnings: ReaderWarning[]): void {
  const units = new Set(frames.map(({ depth }) => depth.unit));
  if (units.size > 1)
    warnings.push(
      warning(
        "units-differ",
        `The depth maps of this folder were read with different units (${[...units].map((unit) => `${1000 * (unit ?? 1)} mm`).join(", ")}): give the unit.`,
      ),
    );
}

/** Where no name says which picture is which, what they hold does. */
async function byContent(pictures: NamedFile[], reader: FolderReader): Promise<Pairs> {
  const kinds = new Map<string, NamedFile[]>();
  for (const file of pictures.slice(0, 2 * FRAMES)) {
    await reader.rest();
    const found = await readRigFile(file).catch(() => undefined);
    if (found) kinds.set(found.kind, [...(kinds.get(found.kind) ?? []), file]);
  }
  const [colours, depths, masks] = [kinds.get("colour") ?? [], kinds.get("depth") ?? [], kinds.get("mask") ?? []];
  if (colours.length === 0 || colours.length !== depths.length) return { pairs: [], says: "" };
  if (depths.length > 1)
    reader.warnings.push(
      warning(
        "pairs-by-content",
        "No name says which files are depth maps; they were recognised by their content and paired in order.",
        { pairs: depths.length },
      ),
    );
  const mask = masks.length === 1 ? masks[0] : undefined;
  return {
    pairs: colours.flatMap((colour, index) =>
      depths[index] ? [{ name: stem(colour.name), colour, depth: depths[index], ...(mask && { mask }) }] : [],
    ),
    says: `${depths.length} pairs by what they hold`,
  };
}

const frameCount: Check = (value, field) => {
  if (!(Number.isInteger(value) && Number(value) > 0))
    throw new BimodalError("option", `${field}: a whole number above zero is needed`, field, refused(value));
};
const checkOptions = object({ unit: metresPerUnit, frames: frameCount, signal });

/** Reads all files of a folder: frames with their cameras, and the poses that relate these. */
export async function readRigFolder(files: NamedFile[], options: FolderOptions = {}): Promise<RigFolder> {
  if (!Array.isArray(files)) throw wrong("files", "a list of files", files);
  for (const [index, file] of files.entries()) checkNamed(file, `files[${index}]`);
  checkOptions(options, "options");
  const { unit, frames: most = FRAMES, signal } = options;
  signal?.throwIfAborted();
  const kept = files
    .map(({ name, bytes }) => ({ name: name.replace(/\\/g, "/").replace(/^\.\//, ""), bytes }))
    .filter(({ name }) => ELSEWHERE.test(name) || !IGNORED.test(name));
  const reader = new FolderReader(signal);
  // Browsers hand folders over in any order.
  const pictures = kept.filter(isRasterFile).sort((a, b) => a.name.localeCompare(b.name, "en", { numeric: true }));
  let found = tum(kept, reader.warnings) ?? byNames(pictures, reader.warnings);
  if (found.pairs.length === 0) found = await byContent(pictures, reader);
  const chosen = spread(found.pairs, most);
  if (chosen.length < found.pairs.length)
    reader.warnings.push(
      warning("pairs-sampled", `${chosen.length} of ${found.pairs.length} pairs are read, evenly spread.`, {
        read: chosen.length,
        pairs: found.pairs.length,
      }),
    );
  const frames: CheckFrame[] = [];
  for (const pair of chosen) {
    const frame = await reader.frame(pair, unit ?? found.unit);
    if (frame) frames.push(frame);
  }
  const folder: RigFolder = { frames, cameras: [], poses: [], readings: reader.readings, warnings: reader.warnings };
  const names = new Set(found.pairs.map(({ name }) => name));
  for (const file of kept) {
    if (isRasterFile(file) || LISTS.test(file.name)) continue;
    // A pose that is called as a frame is where the camera stood then, and relates no two cameras.
    if (/pose/i.test(file.name) && names.has(key(file.name.replace(/pose/gi, "")))) continue;
    const text = await reader.read(file, {});
    if (text?.kind === "cameras")
      folder.cameras.push(...text.cameras.map((each) => ({ ...each, name: each.name ?? stem(file.name) })));
    if (text?.kind === "cameras" || text?.kind === "poses")
      folder.poses.push(...text.poses.filter(({ from, to }) => from !== "world" && to !== "world"));
  }
  addCameras(folder);
  checkUnits(frames, folder.warnings);
  folder.warnings = grouped(folder.warnings);
  if (frames.length + folder.cameras.length + folder.poses.length === 0) {
    throw badFile(
      `no pair of a colour image and a depth map was found among ${files.length} files${folder.warnings.length > 0 ? `: ${folder.warnings[0]?.message}` : ""}`,
    );
  }
  return folder;
}
