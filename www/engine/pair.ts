/**
 * The visitor's files as an image and a depth map. Runs in the worker; the decoders come along with this module.
 * PNG and .npy are read by the library, because a canvas would throw away the lower byte of 16 bits; photographs are
 * the browser's, which also turns them upright. What neither knows comes read already.
 */

import { BimodalError } from "../../pkg/index.js";
import { decodeColour, decodeDepth, decodeMask } from "../../pkg/files.js";
import type { ColorImage, DepthMap, Mask, Pinhole } from "../../pkg/index.js";
import type { OwnFiles } from "./protocol";

/** Longest side the library takes. */
const LONGEST = 4096;
/** Pixels of what the browser decodes, as of a PNG: a canvas of more takes all memory. */
const MOST_PIXELS = 2 ** 27;

export interface Pair {
  image: ColorImage;
  depth: DepthMap;
  notes: Record<string, string>;
}

/** Called with what is being done as soon as it is known, because a large file takes long. */
type Say = (words: string) => void;

export async function readPair(files: OwnFiles, say: Say): Promise<Pair> {
  const notes: Record<string, string> = {};
  const image = await readImage(files, notes, say);
  const depth = await readDepth(files, notes, say);
  return { image, depth, notes };
}

async function readImage(files: OwnFiles, notes: Record<string, string>, say: Say): Promise<ColorImage> {
  const { colour, colourMask, colourCamera } = files;
  const raw =
    files.read?.colour ??
    (await read(colour, "image", async (bytes) => (isOurs(bytes) ? decodeColour(bytes) : decodePhoto(colour))));
  const mask =
    files.read?.colourMask ?? (colourMask && (await read(colourMask, "image.mask", (bytes) => decodeMask(bytes))));
  const factor = factorFor(raw);
  if (factor > 1) {
    notes.image = `${raw.width} × ${raw.height} px exceeds the library's limit; scaled down by ${factor}`;
    say(`${colour.name}: ${notes.image}.`);
  }
  const image = factor > 1 ? shrink(raw, factor) : raw;
  if (mask) image.mask = fitMask(mask, raw, factor, "image.mask");
  // The centre of a block of pixels lies between them.
  if (colourCamera) image.camera = reduced(colourCamera, factor, (factor - 1) / 2);
  if (image.data instanceof Float32Array) return image;
  const told = files.transfer ?? image.transfer;
  image.transfer = told ?? guessTransfer(image.data);
  if (!told) notes["image.transfer"] = `guessed: ${image.transfer === "srgb" ? "sRGB" : "linear"}`;
  return image;
}

async function readDepth(files: OwnFiles, notes: Record<string, string>, say: Say): Promise<DepthMap> {
  const { depth: file, depthMask, depthCamera, unit } = files;
  const raw = files.read?.depth ?? (await read(file, "depth", (bytes) => decodeDepth(bytes)));
  const mask =
    files.read?.depthMask ?? (depthMask && (await read(depthMask, "depth.mask", (bytes) => decodeMask(bytes))));
  const factor = factorFor(raw);
  if (factor > 1) {
    notes.depth = `${raw.width} × ${raw.height} px exceeds the library's limit; every ${factor}th pixel is used`;
    say(`${file.name}: ${notes.depth}.`);
  }
  const depth = factor > 1 ? thin(raw, factor) : raw;
  if (mask) depth.mask = fitMask(mask, raw, factor, "depth.mask");
  if (depthCamera) depth.camera = reduced(depthCamera, factor, Math.floor(factor / 2));
  if (unit !== undefined) depth.unit = unit;
  else if (depthCamera && depth.data instanceof Uint16Array) notes["depth.unit"] = "assumed: 0.001 m (millimetres)";
  return depth;
}

type Extent = Pick<ColorImage, "width" | "height">;

const factorFor = ({ width, height }: Extent): number => Math.ceil(Math.max(width, height) / LONGEST);

const isOurs = (bytes: Uint8Array): boolean =>
  (bytes[0] === 0x89 && bytes[1] === 0x50) || (bytes[0] === 0x93 && bytes[1] === 0x4e);

/** Decodes one file; what goes wrong is said of the slot it was put into. */
async function read<T>(file: File, field: string, decode: (bytes: Uint8Array) => T | Promise<T>): Promise<T> {
  try {
    return await decode(new Uint8Array(await file.arrayBuffer()));
  } catch (error) {
    const reason = error instanceof Error ? error.message : String(error);
    const code = error instanceof BimodalError ? error.code : "file";
    throw new BimodalError(code, `${file.name}: ${reason}`, field, { cause: error });
  }
}

/** JPEG, WebP and whatever else this browser knows, turned as the camera was held. */
async function decodePhoto(file: File): Promise<ColorImage> {
  const bitmap = await createImageBitmap(file, { imageOrientation: "from-image" }).catch(() => {
    throw new BimodalError(
      "file",
      "this is not an image that can be read here; use PNG, JPEG, TIFF, EXR or .npy",
      "image",
    );
  });
  const { width, height } = bitmap;
  if (width * height > MOST_PIXELS) {
    bitmap.close();
    throw new BimodalError("file", `it has ${width} × ${height} px; the limit is ${MOST_PIXELS} pixels`, "image");
  }
  const canvas = new OffscreenCanvas(width, height);
  const context = canvas.getContext("2d");
  if (!context) throw new BimodalError("file", "this browser provides no canvas to decode it", "image");
  context.drawImage(bitmap, 0, 0);
  bitmap.close();
  return { width, height, data: context.getImageData(0, 0, width, height).data };
}

/** 8 bits are made for screens; so are 16 that only repeat 8. Finer levels come from sensors and renderers. */
function guessTransfer(data: Exclude<ColorImage["data"], Float32Array>): "srgb" | "linear" {
  return data instanceof Uint16Array && !data.every((level) => level % 257 === 0) ? "linear" : "srgb";
}

/** Averages whole blocks of pixels, so that every new pixel is made of the same number of old ones. */
function shrink(image: ColorImage, factor: number): ColorImage {
  const width = Math.floor(image.width / factor);
  const height = Math.floor(image.height / factor);
  const channels = image.data instanceof Float32Array ? 3 : 4;
  const data = image.data.slice(0, width * height * channels);
  for (let row = 0; row < height; row++) {
    for (let column = 0; column < width; column++) {
      for (let c = 0; c < channels; c++) {
        let sum = 0;
        for (let y = row * factor; y < (row + 1) * factor; y++) {
          for (let x = column * factor; x < (column + 1) * factor; x++)
            sum += image.data[(y * image.width + x) * channels + c] ?? 0;
        }
        data[(row * width + column) * channels + c] = sum / factor ** 2;
      }
    }
  }
  return { ...image, width, height, data };
}

/** Depth is picked, not averaged: a mean across an edge lies where nothing is. */
function thin(depth: DepthMap, factor: number): DepthMap {
  const width = Math.floor(depth.width / factor);
  const height = Math.floor(depth.height / factor);
  const pick = <T extends Float32Array | Uint16Array>(from: T, to: T, channels: number): T => {
    centres(width, height, depth.width, factor, (target, source) => {
      for (let c = 0; c < channels; c++) to[target * channels + c] = from[source * channels + c] ?? 0;
    });
    return to;
  };
  const { data, points, ...rest } = depth;
  const thinned: DepthMap = { ...rest, width, height };
  if (data instanceof Float32Array) thinned.data = pick(data, new Float32Array(width * height), 1);
  else if (data) thinned.data = pick(data, new Uint16Array(width * height), 1);
  if (points) thinned.points = pick(points, new Float32Array(3 * width * height), 3);
  return thinned;
}

function fitMask(mask: Mask, full: Extent, factor: number, field: string): Uint8Array {
  if (mask.width !== full.width || mask.height !== full.height) {
    throw new BimodalError(
      "size",
      `the mask is ${mask.width} × ${mask.height} px, its image ${full.width} × ${full.height}`,
      field,
    );
  }
  if (factor <= 1) return mask.data;
  const width = Math.floor(full.width / factor);
  const height = Math.floor(full.height / factor);
  const data = new Uint8Array(width * height);
  centres(width, height, full.width, factor, (target, source) => (data[target] = mask.data[source] ?? 0));
  return data;
}

/** Visits the middle pixel of every block of `factor` x `factor`. */
function centres(
  width: number,
  height: number,
  fullWidth: number,
  factor: number,
  visit: (target: number, source: number) => void,
): void {
  const middle = Math.floor(factor / 2);
  for (let row = 0; row < height; row++) {
    for (let column = 0; column < width; column++) {
      visit(row * width + column, (row * factor + middle) * fullWidth + column * factor + middle);
    }
  }
}

/** The camera of a view of which only every `factor`-th pixel is left, the first of them `offset` pixels in. */
function reduced(camera: Pinhole, factor: number, offset: number): Pinhole {
  const { fx, fy, cx, cy } = camera;
  return { ...camera, fx: fx / factor, fy: fy / factor, cx: (cx - offset) / factor, cy: (cy - offset) / factor };
}
