/**
 * Whole folders. Frames are paired by lists of time stamps (TUM RGB-D), by similar names (Redwood's and Open3D's color/ and depth/,
 * 7-Scenes' and other schemes) or by file names that are time stamps. Cameras, poses and units of depth are read from the files beside
 * them.
 *
 * If a file cannot be read, its frame is left out, a warning names it, and the rest of the folder is read.
 */
import { breathe } from "../breathe.js";
import { type Check, object, signal, wrong } from "../check.js";
import { BimodalError, badFile, refused } from "../errors.js";
import { addCameras, inOrder, ofPictures } from "./assign.js";
import { ofNamedPictures } from "./around.js";
import { isOfCarrier } from "./formats/frames.js";
import { isRawName } from "./formats/raw.js";
import { areFives, isVaried, nameOf, sampled } from "./guess.js";
import type { LensFile } from "./lens-files.js";
import { type Pair, type Pairs, tum } from "./lists.js";
import { isLensFile, key, stem } from "./names.js";
import { once } from "./once.js";
import { pairsOf, sayUnpaired } from "./pairs.js";
import { type TextOfFrame, assignOwn, frameOf, split } from "./perframe.js";
import { checkNamed, isRasterFile, isTextFile, metresPerUnit, pixelSize, readRigFile } from "./read.js";
import { isAligned, isOther, roleOf } from "./roles.js";
import type {
  CheckFrame,
  Mask,
  NamedCamera,
  NamedFile,
  NamedPose,
  ReadOptions,
  Reading,
  RigFolder,
  RigReading,
} from "./types.js";
import { sizeBeside, unitBeside } from "./units.js";
import { type ReaderWarning, grouped, ofFile, warning } from "./warnings.js";

/** How `readRigFolder` reads. */
export interface FolderOptions {
  /** Metres per stored unit of all depth maps. */
  unit?: number;
  /** Width and height of raw depth maps, which have no header (.raw, .bin). */
  size?: readonly [width: number, height: number];
  /** The largest number of pairs to read, evenly spread over the folder; default 20. */
  frames?: number;
  /** Cancels the reading between two files; the promise is rejected with its reason. */
  signal?: AbortSignal;
}

const FRAMES = 20;

const lensFiles = once(() => import("./lens-files.js"));
const clouds = once(() => import("./turned.js"));

/** Files that are neither pictures nor calibrations and can be ignored. */
const IGNORED =
  /(^|\/)(\.|__MACOSX|thumbs\.db|readme|licen[cs]e|copying|source\.txt|changelog)|\.(md|html?|py|mjs|js)$/i;
/** A path outside the folder is that of a file given by an option. */
const ELSEWHERE = /^(?:\/|\.\.\/|[a-z]:\/)/i;
const LISTS = /(^|\/)(rgb|depth|associat\w*|accelerometer|groundtruth|times?(tamps)?)\.(txt|csv)$/i;

/** Evenly spread items, including the first and the last. */
function spread<T>(all: T[], most: number): T[] {
  if (all.length <= most) return all;
  return Array.from(
    { length: most },
    (_, index) => all[most === 1 ? 0 : Math.round((index * (all.length - 1)) / (most - 1))] as T,
  );
}

/** Facts about the depth maps that are known before they are read. */
interface Known {
  /** Metres per stored unit, given or in a file. */
  unit: number | undefined;
  /** Metres per stored unit that folders of this kind usually have. */
  supposed: number | undefined;
  sizeOf: (file: NamedFile) => readonly [number, number] | undefined;
}

/** Whether a file's format may hold floats, which are metres. */
const mayBeFloats = ({ name }: NamedFile): boolean => /\.(?:npy|npz|tiff?|exr|pfm|csv|txt|raw|bin)$/i.test(name);

class FolderReader {
  readonly readings: Reading[] = [];
  readonly warnings: ReaderWarning[] = [];
  readonly #signal: AbortSignal | undefined;

  constructor(signal: AbortSignal | undefined) {
    this.#signal = signal;
  }

  /** Lets events pass, such as an abort. */
  async rest(): Promise<void> {
    await breathe();
    this.#signal?.throwIfAborted();
  }

  /** Reads a file; if that fails, adds a warning and returns undefined. */
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

  /** The depth map by the first of its files that can be read. */
  async #depth({ depths }: Pair, { unit, supposed, sizeOf }: Known): Promise<RigReading | undefined> {
    for (const file of depths) {
      const size = sizeOf(file);
      const known = unit ?? supposed;
      const found = await this.read(file, {
        as: "depth",
        ...(size !== undefined && { size }),
        ...(known !== undefined && !mayBeFloats(file) && { unit: known }),
      });
      if (found === undefined) continue;
      const isLevels = found.kind === "depth" && found.depth.data instanceof Uint16Array;
      // A stated unit applies to integers; floats are always metres.
      if (unit !== undefined && mayBeFloats(file) && isLevels) return this.read(file, { as: "depth", unit });
      return found;
    }
    return undefined;
  }

  /** A text counts as used if the unit of depth was read from it. */
  onlyUnit(file: NamedFile, unit: number): void {
    const at = this.warnings.findIndex(({ code, file: name }) => code === "file-left-out" && name === file.name);
    if (at < 0) return;
    this.warnings.splice(at, 1);
    this.readings.push({ name: file.name, says: `the unit of depth, ${nameOf(unit)}`, warnings: [] });
  }

  async frame(pair: Pair, known: Known): Promise<CheckFrame | undefined> {
    const { name, colour, mask } = pair;
    const image = await this.read(colour, { as: "colour" });
    const map = await this.#depth(pair, known);
    if (image?.kind !== "colour" || map?.kind !== "depth") return undefined;
    if (known.unit === undefined && known.supposed !== undefined) this.#checkSupposed(map, known.supposed);
    const masked = mask && (await this.read(mask, { as: "mask" }));
    const frame = { image: image.image, depth: map.depth, name: name === "" ? stem(colour.name) : name };
    if (masked?.kind === "mask") this.#mask(frame, masked.mask, masked.name);
    return frame;
  }

  /**
   * TUM's unit is a fifth of a millimetre. It is trusted if all values are multiples of 5, because TUM's sensor measures whole millimetres.
   */
  #checkSupposed({ name, depth }: Extract<RigReading, { kind: "depth" }>, unit: number): void {
    if (!(depth.data instanceof Uint16Array)) return;
    const sample = sampled(depth.data);
    if (!isVaried(sample) || areFives(sample)) return;
    const message = `no file gives the unit of depth. TUM's ${Math.round(1 / unit)} units per metre were guessed from its lists, but the values are not typical of TUM's sensor; read as millimetres, they would be ${Number((0.001 / unit).toPrecision(3))} times as far. Give the unit.`;
    this.warnings.push(ofFile(name, warning("unit-guessed", message, { unit })));
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

/** If the unit of each depth map was guessed separately, the units have to agree. */
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

/** If no name says which picture is which, their content decides. */
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
      depths[index] ? [{ name: stem(colour.name), colour, depths: [depths[index]], ...(mask && { mask }) }] : [],
    ),
    says: `${depths.length} pairs by their content`,
  };
}

const frameCount: Check = (value, field) => {
  if (!(Number.isInteger(value) && Number(value) > 0))
    throw new BimodalError("option", `${field}: a whole number above zero is needed`, field, refused(value));
};
const checkOptions = object({ unit: metresPerUnit, size: pixelSize, frames: frameCount, signal });

interface Sorted {
  pictures: NamedFile[];
  texts: NamedFile[];
  /** Files that hold only the coefficients of a lens. */
  lenses: LensFile[];
  /** All other files. */
  others: NamedFile[];
}

/** The relevant files of a folder by kind; browsers list a folder's files in any order. */
async function sortedFiles(files: NamedFile[]): Promise<Sorted> {
  const kept = files
    .map(({ name, bytes }) => ({ name: name.replace(/\\/g, "/").replace(/^\.\//, ""), bytes }))
    .filter(({ name }) => ELSEWHERE.test(name) || !IGNORED.test(name));
  const found: Sorted = { pictures: [], texts: [], lenses: [], others: [] };
  for (const file of kept) {
    const lens = isLensFile(file.name) ? (await lensFiles()).lensOf(file) : undefined;
    if (lens !== undefined) {
      found.lenses.push(lens);
      continue;
    }
    const isText = !isRasterFile(file.bytes) && isTextFile(file.bytes);
    const isRaw = !isText && isRawName(file.name) && roleOf(file.name) === "depth";
    if (isRasterFile(file.bytes) || isRaw) found.pictures.push(file);
    else (isText ? found.texts : found.others).push(file);
  }
  found.pictures.sort((a, b) => a.name.localeCompare(b.name, "en", { numeric: true }));
  return found;
}

/** Largest number of poses that a warning names. */
const MOST_NAMED = 4;
/** Names of sensors that take no pictures and no points. */
const INERTIAL = /(?:^|[^a-z])(?:imu|gps|oxts|gyro\w*|accel\w*)(?:[^a-z]|$)/i;

/** Leaves out the poses of inertial sensors, which relate no colour camera to a depth camera. */
export function withoutInertial(poses: NamedPose[], warnings: ReaderWarning[]): NamedPose[] {
  const isInertial = ({ from = "", to = "" }: NamedPose) => INERTIAL.test(from) || INERTIAL.test(to);
  const left = new Set(poses.filter(isInertial).map(({ from, to }) => `${from} to ${to}`));
  if (left.size > 0)
    warnings.push(warning("pose-left-out", `The poses of inertial sensors were left out: ${[...left].join(", ")}.`));
  return poses.filter((pose) => !isInertial(pose));
}

/**
 * Leaves out poses between a sensor and a body, a vehicle, a robot or a target, which do not relate two sensors. The poses between two
 * sensors have been derived from them before.
 */
export function withoutCarriers<T extends NamedPose>(poses: T[], warnings: ReaderWarning[]): T[] {
  const left = new Set(poses.filter(isOfCarrier).map(({ from, to }) => `${from} to ${to}`));
  if (left.size === 0) return poses;
  const names = [...left].slice(0, MOST_NAMED).join(", ");
  const more = left.size > MOST_NAMED ? ` and ${left.size - MOST_NAMED} more` : "";
  warnings.push(
    warning(
      "pose-left-out",
      `Poses of a sensor relative to its carrier (such as a vehicle) or to a target were not used as extrinsics: ${names}${more}.`,
    ),
  );
  return poses.filter((pose) => !isOfCarrier(pose));
}

/** The poses of a file, without poses in the world. A camera without a name has the name of its file, also in these poses. */
export function ofRig(text: Extract<RigReading, { poses: NamedPose[] }>, file: string): NamedPose[] {
  const isUnnamed = text.kind === "cameras" && text.cameras.length === 1 && text.cameras[0]?.name === undefined;
  const called = (end: string | undefined) => (isUnnamed && end === "camera" ? file : end);
  return text.poses
    .filter(({ from, to }) => from !== "world" && to !== "world")
    .map((pose) => {
      const [from, to] = [called(pose.from), called(pose.to)];
      return { ...pose, ...(from !== undefined && { from }), ...(to !== undefined && { to }) };
    });
}

/** The warning about a pose without frames whose file is named after a picture frame. */
const placeOfFrame = (): ReaderWarning =>
  warning(
    "pose-assumed",
    "It is named like a picture and does not name the frames of its pose, so it may be the pose of the camera in the world. It was read as the pose from the depth camera to the colour camera. If that is right, name it depth_to_color.txt, otherwise pose/0.txt or the like.",
  );

/** What a folder's texts give: cameras, poses between them and the unit of the depth maps. `own` has the texts of single frames. */
async function calibrationOf({ texts, others, lenses }: Sorted, frames: ReadonlySet<string>, reader: FolderReader) {
  const found: TextOfFrame[] = [];
  let depthUnit: number | undefined;
  for (const file of [...texts, ...others]) {
    if (LISTS.test(file.name)) continue;
    // A pose whose file is named after a picture frame is the camera's pose at that moment and does not relate two cameras.
    if (/pose/i.test(file.name) && frames.has(key(file.name.replace(/pose/gi, "")))) continue;
    const text = await reader.read(file, {});
    if (text?.kind !== "cameras" && text?.kind !== "poses") continue;
    const called = (each: NamedCamera) => ({ ...each, name: each.name ?? stem(file.name) });
    const cameras = text.kind === "cameras" ? text.cameras.map(called) : [];
    if (text.kind === "cameras") depthUnit ??= text.depthUnit;
    const poses = ofRig(text, stem(file.name));
    found.push({ file: file.name, cameras, poses });
    if (frames.has(key(file.name)) && poses.some(({ from, to }) => from === undefined && to === undefined))
      reader.warnings.push(ofFile(file.name, placeOfFrame()));
  }
  if (lenses.length > 0) reader.readings.push(...(await lensFiles()).giveLenses(lenses, found, reader.warnings));
  const isLeft = withoutInertial(
    found.flatMap(({ poses }) => poses),
    reader.warnings,
  );
  for (const text of found) text.poses = text.poses.filter((pose) => isLeft.includes(pose));
  const [own, common] = split(found, frames);
  const all = { cameras: common.flatMap(({ cameras }) => cameras), poses: common.flatMap(({ poses }) => poses) };
  return { ...all, depthUnit, own };
}

/** Largest number of reasons that an error gives. */
const REASONS = 3;

/**
 * Why a folder holds nothing useful. Files that could not be read are named before files that were not needed, and pictures before texts.
 */
function nothingFound(count: number, warnings: ReaderWarning[], pictures: NamedFile[]) {
  const isPicture = ({ file }: ReaderWarning) => pictures.some(({ name }) => name === file);
  const rank = (each: ReaderWarning) => (each.reason === undefined ? 1 : isPicture(each) ? 0 : 2);
  const reasons = new Map<string, string>();
  for (const each of [...warnings].sort((a, b) => rank(a) - rank(b))) {
    const reason = String(each.reason ?? each.code);
    if (!reasons.has(reason)) reasons.set(reason, each.message);
  }
  const messages = [...reasons.values()].slice(0, REASONS);
  return badFile(
    `no pair of a colour image and a depth map was found among ${count} files${messages.length > 0 ? `: ${messages.join("; ")}` : ""}`,
  );
}

async function framesOf(found: Pairs, most: number, known: Known, reader: FolderReader): Promise<[CheckFrame, Pair][]> {
  const chosen = spread(found.pairs, most);
  if (chosen.length < found.pairs.length)
    reader.warnings.push(
      warning("pairs-sampled", `${chosen.length} of ${found.pairs.length} pairs are read, evenly spread.`, {
        read: chosen.length,
        pairs: found.pairs.length,
      }),
    );
  const frames: [CheckFrame, Pair][] = [];
  for (const pair of chosen) {
    const frame = await reader.frame(pair, known);
    if (frame) frames.push([frame, pair]);
  }
  return frames;
}

/** Reads all files of a folder: frames with their cameras, and the poses that relate these. */
export async function readRigFolder(files: NamedFile[], options: FolderOptions = {}): Promise<RigFolder> {
  if (!Array.isArray(files)) throw wrong("files", "a list of files", files);
  for (const [index, file] of files.entries()) checkNamed(file, `files[${index}]`);
  checkOptions(options, "options");
  const { unit, size, frames: most = FRAMES, signal } = options;
  signal?.throwIfAborted();
  const kept = await sortedFiles(files);
  const { pictures, texts } = kept;
  const reader = new FolderReader(signal);
  let found = tum([...pictures, ...texts], reader.warnings) ?? pairsOf(pictures, reader.warnings);
  if (found.pairs.length === 0)
    found = await byContent(
      pictures.filter(({ name }) => !isOther(roleOf(name))),
      reader,
    );
  const names = new Set(found.pairs.map(({ name }) => name));
  const { depthUnit, own, ...calibration } = await calibrationOf(kept, names, reader);
  const inText = unit === undefined && depthUnit === undefined ? unitBeside(texts, reader.warnings) : undefined;
  for (const file of texts) if (inText?.files.has(file.name)) reader.onlyUnit(file, inText.unit);
  const known: Known = {
    unit: unit ?? depthUnit ?? inText?.unit,
    supposed: found.supposed,
    sizeOf: (file) => size ?? sizeBeside(file, texts),
  };
  const read = await framesOf(found, most, known, reader);
  const frames = read.map(([frame]) => frame);
  const readings = inOrderOf(pictures, reader.readings);
  const folder: RigFolder = { frames, ...calibration, readings, warnings: reader.warnings };
  const paths = frames.length > 0 ? read.flatMap(([, { colour, depths }]) => [colour, ...depths]) : pictures;
  const allAligned = read.length > 0 && read.every(([, { depths }]) => isAligned(depths[0].name));
  const assign = (each: RigFolder) => assigned(each, { paths: paths.map(({ name }) => name), isAligned: allAligned });
  if (own.length > 0 && frames.length > 0) assignOwn(folder, own, assign);
  else Object.assign(folder, assign(withTexts(folder, own)));
  if (folder.warnings.some(({ file = "" }) => isLensFile(file))) (await lensFiles()).doubtLenses(folder.warnings);
  if (frames.length > 0) folder.poses = withoutCarriers(folder.poses, folder.warnings);
  if (frames.some(({ depth }) => depth.points !== undefined))
    folder.poses = (await clouds()).posesForClouds(folder.poses, frames, folder.warnings);
  if (frames.length === 0) sayUnpaired(pictures, folder.warnings);
  checkUnits(frames, folder.warnings);
  if (frames.length + folder.cameras.length + folder.poses.length === 0)
    throw nothingFound(files.length, folder.warnings, pictures);
  folder.warnings = grouped(folder.warnings);
  return folder;
}

/** The descriptions follow the folder's order, with pictures first, because the other files only matter for them. */
function inOrderOf(pictures: NamedFile[], all: readonly Reading[]): Reading[] {
  const isPicture = new Set(pictures.map(({ name }) => name));
  return [true, false].flatMap((first) => all.filter(({ name }) => isPicture.has(name) === first));
}

/** Adds the cameras and poses of these texts to a folder. */
const withTexts = ({ cameras, poses, ...folder }: RigFolder, texts: TextOfFrame[]): RigFolder => ({
  ...folder,
  cameras: [...cameras, ...texts.flatMap((text) => text.cameras)],
  poses: [...poses, ...texts.flatMap((text) => text.poses)],
});

/** Assigns cameras to the frames of a folder, from those that took the pictures of these paths, and sorts its poses. */
export function assigned(folder: RigFolder, { paths, isAligned }: { paths: string[]; isAligned: boolean }): RigFolder {
  const ofPaths = ofPictures(folder, paths);
  const areClouds = folder.frames.length > 0 && folder.frames.every(({ depth }) => depth.points !== undefined);
  const found = areClouds ? ofNamedPictures(ofPaths, paths) : ofPaths;
  found.poses = inOrder(found.poses);
  const own = found.cameras.filter(({ takes }) => takes === undefined || takes === "both");
  addCameras(found, {
    isAligned,
    cameraOf: ({ name = "" }) =>
      own.find((each) => each.name !== undefined && frameOf(each.name) === frameOf(name) && frameOf(name) !== ""),
  });
  return found;
}
