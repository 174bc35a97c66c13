/**
 * JPEG and WebP. Browsers decode them, turn them by their EXIF orientation and convert their colours to sRGB; Node has jpeg-js for JPEG.
 *
 * jpeg-js (0.4, 8 kB gzipped, loaded on demand) is used instead of sharp, a binary of megabytes for each system, and of mozjpeg as wasm,
 * 100 kB. It trusts what a file declares, so sizes, channels and the number of scans are checked first.
 */
import { BimodalError, badFile } from "../../errors.js";
import { exifOrientation, turnedBy, turnedWords } from "./exif.js";
import { checkSize } from "./limits.js";
import type { Picture } from "./picture.js";

/** Largest number of scans. Progressive files have about ten; each costs a pass over all blocks. */
const MOST_SCANS = 64;
const MEMORY = 512;
/** Largest number of segments: tables, remarks and scans. A camera's file has a few dozen. */
const MOST_SEGMENTS = 5000;
/** Smallest number of bits of a block of 8x8: one for its mean, one for its end. */
const BITS_OF_BLOCK = 2;
const MOST_PROFILE = 2 ** 22;

interface Marked {
  width: number;
  height: number;
  orientation: number;
  profile?: Uint8Array;
}

const text = (bytes: Uint8Array, from: number, length: number): string =>
  String.fromCharCode(...bytes.subarray(from, from + length));

/** SOF's sizes, channels and sampling. */
function frame(body: Uint8Array, kind: number, length: number): { width: number; height: number } {
  const [bits = 0, h1 = 0, h0 = 0, w1 = 0, w0 = 0, channels = 0] = body;
  const [width, height] = [(w1 << 8) | w0, (h1 << 8) | h0];
  if (![0xc0, 0xc1, 0xc2].includes(kind))
    throw badFile(
      "this JPEG is lossless, hierarchical or arithmetic, which is not supported; save it as an ordinary JPEG",
    );
  checkSize(width, height);
  if (bits !== 8) throw badFile(`this JPEG has ${bits} bits per sample; only 8 are supported`);
  if (channels !== 1 && channels !== 3)
    throw badFile(
      `this JPEG has ${channels} channels${channels === 4 ? " (CMYK, for print)" : ""}; only grey and RGB are supported`,
    );
  const factors = Array.from({ length: channels }, (_, index) => body[7 + 3 * index] ?? 0);
  if (factors.some((factor) => factor >> 4 < 1 || factor >> 4 > 4 || (factor & 15) < 1 || (factor & 15) > 4))
    throw badFile("this JPEG is damaged: its sampling factors are invalid");
  const full = Math.max(...factors.map((factor) => (factor >> 4) * (factor & 15)));
  const share = factors.reduce((sum, factor) => sum + ((factor >> 4) * (factor & 15)) / full, 0);
  const least = ((width * height * share) / 64) * (kind === 0xc2 ? 1 : BITS_OF_BLOCK);
  if (8 * length < least) throw badFile(`this JPEG is cut off: ${length} bytes cannot hold ${width}x${height} pixels`);
  return { width, height };
}

/** The segments before the pixels. */
function marked(bytes: Uint8Array): Marked {
  let [at, scans, segments, orientation] = [2, 0, 0, 1];
  let size: { width: number; height: number } | undefined;
  let ended = false;
  const profile: Uint8Array[] = [];
  while (at + 2 <= bytes.length) {
    if (bytes[at] !== 0xff) {
      at++;
      continue;
    }
    const kind = bytes[at + 1] ?? 0;
    if (kind === 0xd9) {
      ended = true;
      break;
    }
    // Stuffed bytes, fill bytes and restart markers are not segments.
    if (kind === 0 || kind === 0xff || kind === 1 || (kind >= 0xd0 && kind <= 0xd8)) {
      at += kind === 0xff ? 1 : 2;
      continue;
    }
    if (++segments > MOST_SEGMENTS) throw badFile(`this JPEG is damaged: it has more than ${MOST_SEGMENTS} segments`);
    const length = ((bytes[at + 2] ?? 0) << 8) | (bytes[at + 3] ?? 0);
    const body = bytes.subarray(at + 4, at + 2 + length);
    if (kind >= 0xc0 && kind <= 0xcf && ![0xc4, 0xc8, 0xcc].includes(kind)) {
      if (size) throw badFile("this JPEG is damaged: it has two pictures in one");
      size = frame(body, kind, bytes.length);
    }
    if (kind === 0xda && ++scans > MOST_SCANS) throw badFile(`this JPEG has more than ${MOST_SCANS} scans`);
    if (kind === 0xe1 && text(body, 0, 6) === "Exif\0\0") orientation = exifOrientation(body.subarray(6));
    if (kind === 0xe2 && text(body, 0, 12) === "ICC_PROFILE\0") profile.push(body.subarray(14));
    at += 2 + length;
  }
  if (!size || scans === 0) throw badFile("this JPEG is cut off: it has no pixels");
  // Browsers show missing parts as grey.
  if (!ended) throw badFile("this JPEG is cut off: its end is missing");
  const total = profile.reduce((sum, part) => sum + part.length, 0);
  if (total === 0 || total > MOST_PROFILE) return { ...size, orientation };
  const joined = new Uint8Array(total);
  profile.reduce((from, part) => (joined.set(part, from), from + part.length), 0);
  return { ...size, orientation, profile: joined };
}

/** The decoder's message. Its type errors do not describe the file and get another message. */
function reasonOf(error: unknown): string {
  if (error instanceof TypeError || error instanceof RangeError) return "its segments contradict each other";
  return error instanceof Error ? error.message : String(error);
}

/** Decodes with the browser, which needs only the bytes; `check` refuses a size. */
export async function byBrowser(bytes: Uint8Array, format: string, check = checkSize): Promise<Picture> {
  let bitmap: ImageBitmap;
  try {
    bitmap = await createImageBitmap(new Blob([bytes as Uint8Array<ArrayBuffer>]), { premultiplyAlpha: "none" });
  } catch (error) {
    throw badFile(`this ${format} is damaged or cut off`, error);
  }
  try {
    const { width, height } = bitmap;
    check(width, height);
    const context = new OffscreenCanvas(width, height).getContext("2d", { willReadFrequently: true });
    if (!context) throw badFile(`this browser cannot create a canvas of ${width}x${height} to decode it`);
    context.drawImage(bitmap, 0, 0);
    const data = new Uint8Array(context.getImageData(0, 0, width, height).data);
    return { width, height, channels: 4, data, format, bits: 8, transfer: "srgb", notes: [], warnings: [] };
  } finally {
    bitmap.close();
  }
}

const hasBrowser = (): boolean => typeof createImageBitmap === "function" && typeof OffscreenCanvas === "function";

/** Keeps three of four channels, because the image is opaque. */
function withoutAlpha(picture: Picture): Picture {
  const { width, height, data } = picture;
  const out = new Uint8Array(3 * width * height);
  for (let from = 0, to = 0; to < out.length; from += 4, to += 3) {
    out[to] = data[from] ?? 0;
    out[to + 1] = data[from + 1] ?? 0;
    out[to + 2] = data[from + 2] ?? 0;
  }
  return { ...picture, channels: 3, data: out };
}

export async function readJpeg(bytes: Uint8Array): Promise<Picture> {
  const { width, height, orientation, profile } = marked(bytes);
  if (hasBrowser()) {
    const picture = withoutAlpha(await byBrowser(bytes, "JPEG"));
    if (orientation < 2 || orientation > 8) return picture;
    const { note, turned } = turnedWords(orientation, "EXIF says");
    return { ...picture, notes: [note], warnings: [turned] };
  }
  // Imports the decoder's file instead of the package's main module, which contains the encoder as well.
  const { default: decode } = await import("jpeg-js/lib/decoder.js");
  let data: Uint8Array;
  try {
    data = decode(bytes, {
      useTArray: true,
      formatAsRGBA: false,
      tolerantDecoding: false,
      maxMemoryUsageInMB: MEMORY,
    }).data;
  } catch (error) {
    throw badFile(`this JPEG is damaged or cut off (${reasonOf(error)})`, error);
  }
  if (data.length !== 3 * width * height)
    throw badFile("this JPEG is damaged: it does not have the number of pixels that it declares");
  const picture: Picture = { width, height, channels: 3, data, format: "JPEG", bits: 8, notes: [], warnings: [] };
  return turnedBy(profile ? (await import("./icc.js")).inSrgb(picture, profile) : picture, orientation, "EXIF says");
}

/** The size in a WebP's first part. */
function webpSize(bytes: Uint8Array): void {
  if (bytes.length < 30) throw badFile("this WebP is cut off");
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  const kind = text(bytes, 12, 4);
  const packed = view.getUint32(21, true);
  if (kind === "VP8X") checkSize(1 + (view.getUint32(24, true) & 0xffffff), 1 + (view.getUint32(26, true) >>> 8));
  else if (kind === "VP8L") checkSize(1 + (packed & 0x3fff), 1 + ((packed >>> 14) & 0x3fff));
  else if (kind === "VP8 ") checkSize(view.getUint16(26, true) & 0x3fff, view.getUint16(28, true) & 0x3fff);
  else throw badFile("this WebP is damaged: its first chunk is unknown");
  if (view.getUint32(4, true) + 8 > bytes.length)
    throw badFile(`this WebP is cut off: ${bytes.length} of ${view.getUint32(4, true) + 8} bytes`);
}

export async function readWebp(bytes: Uint8Array): Promise<Picture> {
  webpSize(bytes);
  if (!hasBrowser())
    throw new BimodalError(
      "file",
      "WebP is read in browsers only; convert it to PNG first (dwebp in.webp -o out.png)",
      "file",
    );
  return byBrowser(bytes, "WebP");
}
