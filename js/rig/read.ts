/**
 * Reads any file of a rig, which it recognises by content, into the inputs of the check.
 *
 * Every failure is a BimodalError of the code "file" that names the file and the reason.
 */
import { type Check, number, object, ranged, signal, word, wrong } from "../check.js";
import { BimodalError, badFile, badNamed, refused } from "../errors.js";
import { inOrder } from "./assign.js";
import { pictureColour, pictureMask } from "./colour.js";
import { cloudDepth, pictureDepth } from "./depth.js";
import { colmapText } from "./formats/colmap-cameras.js";
import { type RasterKind, rasterKind } from "./formats/headerless.js";
import { readJpeg, readWebp } from "./formats/jpeg.js";
import { MOST_BYTES } from "./formats/limits.js";
import { archiveText, matrixText } from "./formats/npy-matrix.js";
import type { Cloud, Picture, Points } from "./formats/picture.js";
import { pngPicture } from "./formats/png.js";
import { isRawName, sizeInName } from "./formats/raw.js";
import { textOf } from "./formats/decode.js";
import { kindOfPicture, nameWarnings, unitOfName } from "./recognise.js";
import { once } from "./once.js";
import { CONTENTS, roleOf } from "./roles.js";
import type { NamedFile, ReadOptions, RigReading, Unnamed } from "./types.js";
import { distinct } from "./warnings.js";
import { inWords } from "./words.js";

type Content = Unnamed<RigReading>;

/** The module about formats that are not supported, loaded with the first file of no known picture format. */
const refusals = once(() => import("./formats/containers.js"));
const texts = once(() => import("./formats/text.js"));
const clouds = () => import("./formats/pointclouds.js");
const exr = once(() => import("./formats/exr.js"));
const tiff = once(() => import("./formats/tiff.js"));
const npy = once(() => import("./formats/npy.js"));
const pnm = once(() => import("./formats/pnm.js"));
const raw = once(() => import("./formats/raw-pixels.js"));
const tables = once(() => import("./formats/table-cells.js"));
const CLOUDS: Record<"ply" | "pcd" | "las", (bytes: Uint8Array) => Promise<Cloud | Points>> = {
  ply: async (bytes) => (await clouds()).readPly(bytes),
  pcd: async (bytes) => (await clouds()).readPcd(bytes),
  las: async (bytes) => (await clouds()).readLas(bytes),
};
const isCloud = (kind: RasterKind): kind is keyof typeof CLOUDS => Object.hasOwn(CLOUDS, kind);

const PICTURES: Record<
  Exclude<RasterKind, keyof typeof CLOUDS | "points">,
  (bytes: Uint8Array, options: ReadOptions) => Picture | Promise<Picture>
> = {
  png: (bytes) => pngPicture(bytes),
  jpeg: readJpeg,
  webp: readWebp,
  tiff: async (bytes) => (await tiff()).readTiff(bytes),
  exr: async (bytes, { as }) => (await exr()).readExr(bytes, as === "depth"),
  pfm: async (bytes) => (await pnm()).readPfm(bytes),
  pnm: async (bytes) => (await pnm()).readPnm(bytes),
  npy: async (bytes) => (await npy()).npyPicture(bytes),
  npz: async (bytes) => (await npy()).npzPicture(bytes),
  colmap: async (bytes) => (await raw()).readColmapMap(bytes),
  table: async (bytes) => (await tables()).readTable(bytes),
};

/** Whether a file holds pixels or points rather than a text of cameras and poses. */
export const isRasterFile = (bytes: Uint8Array): boolean => rasterKind(bytes) !== undefined;
/** Whether a file is a text, or a binary calibration that is read as one. */
export const isTextFile = (bytes: Uint8Array): boolean => (textOf(bytes) ?? writtenOf(bytes)) !== undefined;
/** A binary calibration as the text with the same content. */
const writtenOf = (bytes: Uint8Array): string | undefined =>
  colmapText(bytes) ?? matrixText(bytes) ?? archiveText(bytes);

/** Reads a picture as the kind that its content shows, or as the requested kind. */
export function ofPicture(name: string, picture: Picture, options: ReadOptions): Content {
  const kind = options.as ?? (options.inverse ? "depth" : kindOfPicture(name, picture));
  const warnings = [...picture.warnings, ...nameWarnings(name, picture, kind, options)];
  if (kind === "colour") return pictureColour({ ...picture, warnings });
  if (kind === "depth") return pictureDepth({ ...picture, ...unitOfName(name, picture), warnings }, options);
  if (kind === "mask") return pictureMask({ ...picture, warnings });
  throw badFile(`it is a picture (${picture.format}) where ${kind} were expected`);
}

async function ofCloud(cloud: Cloud | Points, options: ReadOptions): Promise<Content> {
  if (options.as !== undefined && options.as !== "depth")
    throw badFile(`it is a cloud of points (${cloud.format}) where ${options.as} was expected`);
  if (options.inverse)
    throw badFile(`it is a cloud of points (${cloud.format}), whose z is a depth, not an inverse depth`);
  return "scan" in cloud ? (await clouds()).pointsDepth(cloud, options) : cloudDepth(cloud, options);
}

async function ofText(file: string, text: string, { as }: ReadOptions): Promise<Content> {
  if (as === "colour" || as === "depth" || as === "mask")
    throw badFile(`it is a text where a ${as === "depth" ? "depth map" : `${as} image`} was expected`);
  const { readText } = await texts();
  const { cameras, poses: found, warnings, format, depthUnit } = await readText(text, file);
  const poses = inOrder(found);
  const reading = { says: `${format}: ${inWords(cameras, poses)}`, warnings: distinct(warnings) };
  if (as === "cameras" && cameras.length === 0) throw badFile(`it holds ${inWords(cameras, poses)}, but no camera`);
  if (as === "poses" && poses.length === 0) throw badFile(`it holds ${inWords(cameras, poses)}, but no transform`);
  return cameras.length > 0 && as !== "poses"
    ? { kind: "cameras", cameras, poses, ...(depthUnit !== undefined && { depthUnit }), ...reading }
    : { kind: "poses", poses, ...reading };
}

/** A file without known first bytes: raw pixels of a given size, headerless points, or a text. */
async function ofOthers({ name, bytes }: NamedFile, isPoints: boolean, options: ReadOptions): Promise<Content> {
  const { knownContainer, knownText, pointList, pointsRefused, rawRefused } = await refusals();
  const written = writtenOf(bytes);
  const container = written === undefined ? knownContainer(name, bytes) : undefined;
  if (container !== undefined) throw container;
  const size = options.size ?? sizeInName(name, bytes);
  if (size !== undefined && isRawName(name)) return ofPicture(name, (await raw()).readRaw(bytes, size), options);
  if (written !== undefined) return ofText(name, written, options);
  const text = textOf(bytes);
  const scan = isPoints || (text === undefined && /\.bin$/i.test(name)) ? (await clouds()).readBin(bytes) : undefined;
  if (scan !== undefined && roleOf(name) === "radar") throw badFile(`its name says that it holds ${CONTENTS.radar}`);
  if (scan !== undefined) return ofCloud(scan, options);
  if (isPoints) throw pointsRefused();
  const listRefused = pointList(bytes);
  const list = listRefused && (await clouds()).readXyz(bytes);
  if (list !== undefined) return ofCloud(list, options);
  if (text === undefined) throw listRefused ?? rawRefused(bytes);
  const refusal = knownText(text) ?? listRefused;
  if (refusal !== undefined) throw refusal;
  return ofText(name, text, options);
}

async function content({ name, bytes }: NamedFile, options: ReadOptions): Promise<Content> {
  if (bytes.length === 0) throw badFile("it is empty");
  const kind = rasterKind(bytes);
  // Recordings are refused by name, whatever their size; a camera's raw photograph has the first bytes of a TIFF.
  const isDoubtful = bytes.length > MOST_BYTES || kind === "tiff";
  const container = isDoubtful ? (await refusals()).knownContainer(name, bytes) : undefined;
  if (container !== undefined) throw container;
  if (bytes.length > MOST_BYTES)
    throw badFile(
      `it is ${(bytes.length / 2 ** 20).toFixed(0)} MB large; up to ${MOST_BYTES / 2 ** 20} MB are supported`,
      undefined,
      { problem: "too-large" },
    );
  if (kind === undefined || kind === "points") return ofOthers({ name, bytes }, kind === "points", options);
  if (isCloud(kind)) return ofCloud(await CLOUDS[kind](bytes), options);
  const picture = await PICTURES[kind](bytes, options);
  const { scan, format, notes, warnings } = picture;
  if (scan) return ofCloud({ format, scan, isMetric: false, notes, warnings }, options);
  // An array of an archive has its own name.
  return ofPicture(picture.name ?? name, picture, options);
}

function reasonOf(error: unknown): string {
  if (error instanceof BimodalError) return error.message;
  // A file that was cut off: a DataView throws a RangeError for an offset beyond its end.
  if (error instanceof RangeError) return "it is cut off or damaged: an offset in it lies beyond its end";
  return `it is damaged or cut off (${error instanceof Error ? error.message : String(error)})`;
}

/** The error with the file's name added. */
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
    throw new BimodalError("option", `${field}: must be metres per stored unit, above zero`, field, refused(value));
};
export const pixelSize: Check = (value, field) => {
  const isSide = (side: unknown) => Number.isInteger(side) && Number(side) > 0;
  if (!(Array.isArray(value) && value.length === 2 && value.every(isSide)))
    throw new BimodalError("option", `${field}: must be width and height in pixels, such as [640, 480]`, field);
};
/** A number other than zero. */
const factor: Check = (value, field) => {
  number(value, field);
  if (value === 0 || !Number.isFinite(value))
    throw new BimodalError("option", `${field}: must be a finite number other than zero`, field, refused(value));
};
const checkOptions = object({
  as: word("colour", "depth", "mask", "cameras", "poses"),
  unit: metresPerUnit,
  inverse: object({ numerator: factor, offset: ranged({ kind: "number" }) }),
  size: pixelSize,
  signal,
});

/** Reads one file. `warnings` lists what was guessed or looks wrong. */
export async function readRigFile(file: NamedFile, options: ReadOptions = {}): Promise<RigReading> {
  checkNamed(file, "file");
  checkOptions(options, "options");
  options.signal?.throwIfAborted();
  try {
    return { name: file.name, ...(await content(file, options)) };
  } catch (error) {
    throw named(file.name, error);
  } finally {
    options.signal?.throwIfAborted();
  }
}
