/**
 * PNG of 8 and 16 bits: what the file says of itself is checked against its length, its checksums and the length of what it inflates to
 * before fast-png sees it, since fast-png (8.0) inflates whatever there is: a kilobyte may say a megabyte, and a file cut off within its
 * last row would end in zeros.
 */
import { convertIndexedToRgb, decode, hasPngSignature } from "fast-png";
import { badFile } from "./errors.js";
import { inflateExactly } from "./inflate.js";
import type { Raster } from "./npy.js";

export { hasPngSignature as isPng };

/** What else a PNG says, as it stands in the file. */
export interface PngRemarks {
  /** Bits of a channel in the file. */
  bits: number;
  /** Chunks that say how colours are meant and which side is up: iCCP, sRGB, gAMA, cHRM, cICP, eXIf. */
  chunks: Map<string, Uint8Array>;
}

const SIGNATURE = 8;
/** Length, type and checksum. */
const FRAME = 12;
/** Bytes by which careless encoders exceed what they were given. */
const SPARE = 65_536;
const KEPT = ["IHDR", "PLTE", "tRNS"];
const REMARKS = ["iCCP", "sRGB", "gAMA", "cHRM", "cICP", "eXIf"];

const TABLE = Uint32Array.from({ length: 256 }, (_, byte) => {
  let value = byte;
  for (let bit = 0; bit < 8; bit++) value = value & 1 ? 0xedb88320 ^ (value >>> 1) : value >>> 1;
  return value;
});

function crc32(bytes: Uint8Array): number {
  let value = 0xffffffff;
  for (let at = 0; at < bytes.length; at++) value = (TABLE[(value ^ (bytes[at] ?? 0)) & 255] ?? 0) ^ (value >>> 8);
  return ~value >>> 0;
}

interface Parts {
  kept: Map<string, Uint8Array>;
  remarks: Map<string, Uint8Array>;
  pixels: Uint8Array;
}

/** The chunks that matter, and the compressed pixels in one piece. */
function parts(bytes: Uint8Array): Parts {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  const kept = new Map<string, Uint8Array>();
  const remarks = new Map<string, Uint8Array>();
  const pieces: Uint8Array[] = [];
  for (let at = SIGNATURE; ; ) {
    if (at + FRAME > bytes.length) throw badFile("this PNG is cut off: its end is missing");
    const length = view.getUint32(at);
    const type = String.fromCharCode(...bytes.subarray(at + 4, at + 8));
    if (length > bytes.length - at - FRAME) throw badFile(`this PNG is cut off or damaged in its part ${JSON.stringify(type)}`);
    const body = bytes.subarray(at + 8, at + 8 + length);
    const needed = KEPT.includes(type) || type === "IDAT";
    const intact = () => view.getUint32(at + 8 + length) === crc32(bytes.subarray(at + 4, at + 8 + length));
    if (needed && !intact()) throw badFile(`this PNG is damaged: the checksum of its part ${type} is wrong`);
    if (type === "IDAT") pieces.push(body);
    else if (KEPT.includes(type)) kept.set(type, body);
    else if (REMARKS.includes(type) && intact()) remarks.set(type, body);
    else if (type === "IEND") break;
    at += FRAME + length;
  }
  const pixels = new Uint8Array(pieces.reduce((sum, piece) => sum + piece.length, 0));
  let from = 0;
  for (const piece of pieces) {
    pixels.set(piece, from);
    from += piece.length;
  }
  return { kept, remarks, pixels };
}

const ADAM7 = [[0, 0, 8, 8], [4, 0, 8, 8], [0, 4, 4, 8], [2, 0, 4, 4], [0, 2, 2, 4], [1, 0, 2, 2], [0, 1, 1, 2]] as const;
/** Channels of each colour type. */
const CHANNELS: Record<number, number> = { 0: 1, 2: 3, 3: 1, 4: 2, 6: 4 };

interface Header {
  width: number;
  height: number;
  bits: number;
  /** Bytes that the pixels inflate to. */
  inflated: number;
}

function header({ kept }: Parts): Header {
  const body = kept.get("IHDR");
  if (body?.length !== 13) throw badFile("this PNG has no header");
  const view = new DataView(body.buffer, body.byteOffset, body.byteLength);
  const [width, height, bits] = [view.getUint32(0), view.getUint32(4), view.getUint8(8)];
  const channels = CHANNELS[view.getUint8(9)];
  const interlaced = view.getUint8(12) === 1;
  if (width === 0 || height === 0) throw badFile(`this PNG says that it is ${width}x${height} pixels large`);
  if (channels === undefined) throw badFile(`this PNG says that its colours are of the type ${view.getUint8(9)}, which there is not`);
  if (interlaced && bits < 8) throw badFile("this PNG is interlaced with fewer than 8 bits, which is not read here; save it without interlace");
  if ((kept.get("PLTE")?.length ?? 0) > 768) throw badFile("this PNG is damaged: its palette has more than 256 colours");
  const rows = (across: number, down: number) => (across > 0 && down > 0 ? down * (1 + Math.ceil((across * channels * bits) / 8)) : 0);
  const pass = ([x, y, dx, dy]: readonly [number, number, number, number]) => rows(Math.ceil((width - x) / dx), Math.ceil((height - y) / dy));
  const inflated = interlaced ? ADAM7.reduce((sum, each) => sum + pass(each), 0) : rows(width, height);
  return { width, height, bits, inflated };
}

/** The same file with nothing in it but what the decoder needs; checksums have been checked. */
function bare({ kept, pixels }: Parts): Uint8Array {
  const chunks: [string, Uint8Array][] = [...kept, ["IDAT", pixels], ["IEND", new Uint8Array(0)]];
  const bytes = new Uint8Array(chunks.reduce((sum, [, body]) => sum + FRAME + body.length, SIGNATURE));
  const view = new DataView(bytes.buffer);
  bytes.set([0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a]);
  let at = SIGNATURE;
  for (const [type, body] of chunks) {
    view.setUint32(at, body.length);
    for (let letter = 0; letter < 4; letter++) view.setUint8(at + 4 + letter, type.charCodeAt(letter));
    bytes.set(body, at + 8);
    at += FRAME + body.length;
  }
  return bytes;
}

/** Grey levels of fewer than 8 bits lie packed, each row from a new byte; they come out one for each byte, unscaled. */
function unpack(packed: Uint8Array, width: number, height: number, bits: number): Uint8Array {
  const levels = new Uint8Array(width * height);
  const stride = Math.ceil((width * bits) / 8);
  for (let row = 0; row < height; row++) {
    for (let column = 0; column < width; column++) {
      const bit = column * bits;
      const byte = packed[row * stride + (bit >> 3)] ?? 0;
      levels[row * width + column] = (byte >> (8 - bits - (bit & 7))) & ((1 << bits) - 1);
    }
  }
  return levels;
}

function pixelsOf(bytes: Uint8Array): Raster<Uint8Array | Uint16Array> {
  const png = decode(bytes);
  const { width, height } = png;
  if (png.palette) return { width, height, channels: png.palette[0]?.length ?? 3, data: convertIndexedToRgb(png) };
  if (png.data instanceof Uint16Array) return { width, height, channels: png.channels, data: png.data };
  const data = new Uint8Array(png.data);
  if (png.depth < 8) {
    // Full white is 1, 3 or 15 here.
    const scale = 255 / (2 ** png.depth - 1);
    return { width, height, channels: 1, data: unpack(data, width, height, png.depth).map((level) => level * scale) };
  }
  return { width, height, channels: png.channels, data };
}

/** `checkSize` may refuse a size before anything is made of it. */
export function readPng(bytes: Uint8Array, checkSize?: (width: number, height: number) => void): Raster<Uint8Array | Uint16Array> & PngRemarks {
  const found = parts(bytes);
  const { width, height, bits, inflated } = header(found);
  checkSize?.(width, height);
  // What deflate cannot make shorter it keeps, with five bytes for 65535.
  if (found.pixels.length > inflated + inflated / 1000 + SPARE) throw badFile("this PNG is damaged: its pixels are longer compressed than not");
  inflateExactly(found.pixels, inflated, "this PNG");
  try {
    return { ...pixelsOf(bare(found)), bits, chunks: found.remarks };
  } catch (error) {
    throw badFile(`this PNG is damaged (${error instanceof Error ? error.message : String(error)})`, error);
  }
}
