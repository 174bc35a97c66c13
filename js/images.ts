/**
 * Reads colour images from addresses, files, bytes, and elements and bitmaps of a page.
 *
 * The readers for rigs read files. They keep 16 bits, follow colour profiles and orientation, and are loaded with the first file. The
 * browser reads all other formats.
 */
import { brief, object, signal, wrong } from "./check.js";
import { BimodalError, badNamed } from "./errors.js";
import { nodeModule } from "./node.js";
import { kindOf } from "./rig/formats/kinds.js";
import { checkSize } from "./rig/formats/limits.js";
import type { ColorImage, ImageOptions, ImageSource } from "./types/index.js";

const checkOptions = object({ signal });

const isImageData = (source: unknown): source is ImageData =>
  typeof ImageData !== "undefined" && source instanceof ImageData;

/** A scheme: at least two letters before a colon, because a single letter is a drive of Windows. */
const SCHEME = /^[a-z][a-z\d+.-]+:/i;

async function fetched(address: string | URL, signal: AbortSignal | undefined): Promise<Uint8Array> {
  let response: Response;
  try {
    response = await fetch(address, signal ? { signal } : {});
  } catch (error) {
    signal?.throwIfAborted();
    const reason = "it cannot be reached, or its server does not permit other origins to read it (CORS)";
    throw badNamed(nameOf(address), reason, error);
  }
  if (!response.ok) throw badNamed(nameOf(address), `its server answered with status ${response.status}`);
  return new Uint8Array(await response.arrayBuffer());
}

/** The bytes at an address; a text without a scheme is a path in Node, and relative to the page elsewhere. */
async function located(address: string | URL, signal: AbortSignal | undefined): Promise<Uint8Array> {
  const disk = nodeModule("node:fs/promises");
  const text = String(address);
  const isPath = !SCHEME.test(text);
  if (!disk || !(isPath || text.startsWith("file:"))) return fetched(address, signal);
  try {
    return await disk.readFile(isPath ? text : new URL(text), signal ? { signal } : {});
  } catch (error) {
    signal?.throwIfAborted();
    throw badNamed(text, `it cannot be read (${error instanceof Error ? error.message : String(error)})`, error);
  }
}

/** The bytes of a source that is a file; nothing for other sources. */
async function bytesOf(source: ImageSource, signal: AbortSignal | undefined): Promise<Uint8Array | undefined> {
  if (source instanceof Uint8Array) return source;
  if (source instanceof ArrayBuffer) return new Uint8Array(source);
  if (source instanceof Blob) return new Uint8Array(await source.arrayBuffer());
  if (typeof source === "string" || source instanceof URL) return located(source, signal);
  return undefined;
}

/** The name of a source in errors if the source is a file: a path, an address, or the name of a page's `File`. */
function nameOf(source: ImageSource): string {
  // A data address holds the whole picture and would be too long for a message.
  if (typeof source === "string" || source instanceof URL)
    return /^data:/i.test(String(source)) ? brief(String(source)) : String(source);
  return typeof File !== "undefined" && source instanceof File ? source.name : "image";
}

const canDraw = (): boolean => typeof createImageBitmap === "function" && typeof OffscreenCanvas === "function";

async function decoded(bytes: Uint8Array, name: string, signal: AbortSignal | undefined): Promise<ColorImage> {
  if (bytes.length === 0) throw badNamed(name, "it is empty");
  // GIF, AVIF and all other formats that a browser shows.
  if (kindOf(bytes) === undefined && canDraw()) return shown(bytes, name);
  const { readRigFile } = await import("./rig/read.js");
  const reading = await readRigFile({ name, bytes }, { as: "colour", ...(signal && { signal }) });
  if (reading.kind !== "colour") throw badNamed(name, "it is not a colour image");
  return reading.image as ColorImage;
}

/** Decodes a file in the browser. */
async function shown(bytes: Uint8Array, name: string): Promise<ColorImage> {
  try {
    return await drawn(new Blob([bytes as Uint8Array<ArrayBuffer>]));
  } catch (error) {
    if (!(error instanceof BimodalError) || error.code !== "file") throw error;
    throw badNamed(name, error.details?.reason ?? error.message, error.cause, error.details);
  }
}

/** Decodes a source in the browser to 8-bit sRGB, upright. */
async function drawn(source: ImageBitmapSource): Promise<ColorImage> {
  const bitmap = await bitmapOf(source);
  try {
    const { width, height } = bitmap;
    checkSize(width, height);
    const context = new OffscreenCanvas(width, height).getContext("2d", {
      colorSpace: "srgb",
      willReadFrequently: true,
    });
    if (!context)
      throw new BimodalError("memory", "source: there is no memory left for a canvas of its size", "source");
    context.drawImage(bitmap, 0, 0);
    return { width, height, data: context.getImageData(0, 0, width, height).data };
  } catch (error) {
    if (error instanceof BimodalError) throw error;
    const message =
      'source: the browser does not let scripts read its pixels; an image of another origin needs crossOrigin = "anonymous" and a server that permits it';
    throw new BimodalError("unsupported", message, "source", { cause: error });
  } finally {
    bitmap.close();
  }
}

async function bitmapOf(source: ImageBitmapSource): Promise<ImageBitmap> {
  if (!canDraw()) throw wrong("source", "a path, an address or the bytes of a file", source);
  try {
    // An element may still be loading.
    if (typeof HTMLImageElement !== "undefined" && source instanceof HTMLImageElement) await source.decode();
    return await createImageBitmap(source, { colorSpaceConversion: "default", premultiplyAlpha: "none" });
  } catch (error) {
    if (error instanceof TypeError)
      throw wrong("source", "an image, a canvas, a video frame, a file, its bytes or its address", source);
    const reason = `the browser cannot decode it (${error instanceof Error ? error.message : String(error)})`;
    throw new BimodalError("file", `source: ${reason}`, "source", { cause: error, details: { reason } });
  }
}

/**
 * A colour image from an element or a bitmap of a page, a canvas, a video frame, a file, its bytes, its address, or in Node its path.
 *
 * The image is upright, turned by the orientation that the file names. Integers are in sRGB, converted from the file's colour profile; PNG and
 * TIFF of 16 bits keep them, EXR, PFM and float .npy stay linear floats. Sources of a page (elements, canvases, bitmaps, video frames) have
 * 8 bits in sRGB; a video gives its current frame. The image has no camera: add one by `{ ...image, camera }`.
 *
 * @throws BimodalError of code "file" if nothing can be read or decoded, "unsupported" if another origin does not permit reading its
 * pixels, "type" if the source is none of these.
 */
export async function imageFrom(source: ImageSource, options: ImageOptions = {}): Promise<ColorImage> {
  checkOptions(options, "options");
  const { signal } = options;
  signal?.throwIfAborted();
  const image = await read(source, signal);
  signal?.throwIfAborted();
  return image;
}

async function read(source: ImageSource, signal: AbortSignal | undefined): Promise<ColorImage> {
  const isPlain = isImageData(source) && source.data instanceof Uint8ClampedArray && source.colorSpace === "srgb";
  if (isPlain) return { width: source.width, height: source.height, data: source.data.slice() as Uint8ClampedArray };
  const bytes = await bytesOf(source, signal);
  return bytes ? decoded(bytes, nameOf(source), signal) : drawn(source as ImageBitmapSource);
}
