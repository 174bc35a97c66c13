/**
 * Any file of a rig, recognised by its content, as what the check takes.
 *
 * Whatever is wrong with a file comes out as one BimodalError of code "file" that names the file and the reason.
 */
import { type Check, object, signal, word, wrong } from "../check.js";
import { BimodalError, badFile, badNamed, refused } from "../errors.js";
import { readNpy } from "../npy.js";
import { looksLikeDepth, looksLikeMask, pictureColour, pictureMask } from "./colour.js";
import { cloudDepth, isGrey, pictureDepth } from "./depth.js";
import { readExr } from "./formats/exr.js";
import { readJpeg, readWebp } from "./formats/jpeg.js";
import { type Kind, kindOf } from "./formats/kinds.js";
import { MOST_BYTES, checkSize } from "./formats/limits.js";
import { readBin } from "./formats/bin.js";
import { readPcd } from "./formats/pcd.js";
import type { Cloud, Picture, Points } from "./formats/picture.js";
import { readPly } from "./formats/ply.js";
import { pngPicture } from "./formats/png.js";
import { readPfm, readPnm } from "./formats/pnm.js";
import { readText, textOf } from "./formats/text.js";
import { readTiff } from "./formats/tiff.js";
import { pointsDepth } from "./scan.js";
import type { NamedFile, ReadOptions, RigReading } from "./types.js";
import { inWords, strange } from "./words.js";
import { distinct } from "./warnings.js";

type Unnamed<T> = T extends unknown ? Omit<T, "name"> : never;
type Content = Unnamed<RigReading>;

function npyPicture(bytes: Uint8Array): Picture {
  const raster = readNpy(bytes);
  checkSize(raster.width, raster.height);
  return { ...raster, format: "npy", bits: 8 * raster.data.BYTES_PER_ELEMENT, notes: [], warnings: [] };
}

const PICTURES: Record<
  Exclude<Kind, "ply" | "pcd">,
  (bytes: Uint8Array, options: ReadOptions) => Picture | Promise<Picture>
> = {
  png: pngPicture,
  jpeg: readJpeg,
  webp: readWebp,
  tiff: readTiff,
  exr: (bytes, { as }) => readExr(bytes, as === "depth"),
  pfm: readPfm,
  pnm: readPnm,
  npy: npyPicture,
};

/** Whether it is a file of pixels or points, and no text of cameras and poses. */
export const isRasterFile = ({ name, bytes }: NamedFile): boolean =>
  kindOf(bytes) !== undefined || readBin({ name, bytes }) !== undefined;

const isColourful = (picture: Picture): boolean => picture.channels >= 3 && !isGrey(picture);

const CALLED_MASK = /mask|segm/i;

/** What a picture is where nobody said: by its content, and where both would do, by the name of its file. */
function guessedKind(name: string, picture: Picture): "colour" | "depth" | "mask" {
  // A drawn mask may have soft edges.
  if (looksLikeMask(picture) || (CALLED_MASK.test(name) && picture.bits === 8 && isGrey(picture))) return "mask";
  if (picture.data instanceof Float32Array && picture.channels === 3)
    return picture.format === "npy" ? "depth" : "colour";
  if (isColourful(picture)) return "colour";
  const file = name.toLowerCase();
  if (/depth|dist|disp|range/.test(file)) return "depth";
  if (/rgb|colou?r|grey|gray|image|photo/.test(file)) return "colour";
  return looksLikeDepth(picture) ? "depth" : "colour";
}

function ofPicture(name: string, picture: Picture, options: ReadOptions): Content {
  const kind = options.as ?? guessedKind(name, picture);
  if (kind === "colour") return pictureColour(picture);
  if (kind === "depth") return pictureDepth(picture, options);
  if (kind === "mask") return pictureMask(picture);
  throw badFile(`it is a picture (${picture.format}) where ${kind} were asked for`);
}

async function ofCloud(cloud: Cloud | Points, options: ReadOptions): Promise<Content> {
  if (options.as !== undefined && options.as !== "depth")
    throw badFile(`it is a cloud of points (${cloud.format}) where ${options.as} was asked for`);
  return "scan" in cloud ? pointsDepth(cloud, options) : cloudDepth(cloud, options);
}

async function ofText(text: string, { as }: ReadOptions): Promise<Content> {
  if (as === "colour" || as === "depth" || as === "mask")
    throw badFile(`it is a text where a ${as === "depth" ? "depth map" : `${as} image`} was asked for`);
  const { cameras, poses, warnings, format } = await readText(text);
  const reading = { says: `${format}: ${inWords(cameras, poses)}`, warnings: distinct(warnings) };
  if (as === "cameras" && cameras.length === 0) throw badFile(`it holds ${inWords(cameras, poses)}, but no camera`);
  if (as === "poses" && poses.length === 0) throw badFile(`it holds ${inWords(cameras, poses)}, but no motion`);
  return cameras.length > 0 && as !== "poses"
    ? { kind: "cameras", cameras, poses, ...reading }
    : { kind: "poses", poses, ...reading };
}

async function content({ name, bytes }: NamedFile, options: ReadOptions): Promise<Content> {
  if (bytes.length === 0) throw badFile("it is empty");
  if (bytes.length > MOST_BYTES)
    throw badFile(
      `it is ${(bytes.length / 2 ** 20).toFixed(0)} MB large; up to ${MOST_BYTES / 2 ** 20} MB are read`,
      undefined,
      { problem: "too-large" },
    );
  const kind = kindOf(bytes);
  if (kind === "ply") return ofCloud(readPly(bytes), options);
  if (kind === "pcd") return ofCloud(readPcd(bytes), options);
  if (kind !== undefined) return ofPicture(name, await PICTURES[kind](bytes, options), options);
  const scan = readBin({ name, bytes });
  if (scan) return ofCloud(scan, options);
  const text = textOf(bytes);
  if (text === undefined) throw strange(bytes);
  return ofText(text, options);
}

function reasonOf(error: unknown): string {
  if (error instanceof BimodalError) return error.message;
  // Readers look at bytes through views that refuse what lies beyond their end.
  if (error instanceof RangeError) return "it is cut off or damaged: it points beyond its own end";
  return `it is damaged or cut off (${error instanceof Error ? error.message : String(error)})`;
}

/** The error with the file's name in it. */
function named(name: string, error: unknown): BimodalError {
  if (error instanceof BimodalError && error.code !== "file") return error;
  const reason = reasonOf(error);
  const [cause, details] = error instanceof BimodalError ? [error.cause, error.details] : [error, {}];
  return badNamed(name, reason, cause, details);
}

export function checkNamed(file: NamedFile, field: string): void {
  if (typeof file?.name !== "string" || !(file.bytes instanceof Uint8Array))
    throw wrong(field, "{ name: string, bytes: Uint8Array }", file);
}

export const metresPerUnit: Check = (value, field) => {
  if (!(typeof value === "number" && value > 0 && Number.isFinite(value)))
    throw new BimodalError("option", `${field}: metres per stored unit, above zero, are needed`, field, refused(value));
};
const checkOptions = object({ as: word("colour", "depth", "mask", "cameras", "poses"), unit: metresPerUnit, signal });

function checked(file: NamedFile, options: ReadOptions): void {
  checkNamed(file, "file");
  checkOptions(options, "options");
}

/** Reads one file. What was guessed, or looks wrong, is in `warnings`. */
export async function readRigFile(file: NamedFile, options: ReadOptions = {}): Promise<RigReading> {
  checked(file, options);
  options.signal?.throwIfAborted();
  try {
    return { name: file.name, ...(await content(file, options)) };
  } catch (error) {
    throw named(file.name, error);
  } finally {
    options.signal?.throwIfAborted();
  }
}
