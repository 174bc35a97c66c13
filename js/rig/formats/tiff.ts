/**
 * TIFF and BigTIFF of one picture: integers, and floats of 16, 32 and 64 bits, in strips or tiles, plain, LZW, deflate, PackBits, ZSTD or
 * LERC, with either predictor.
 *
 * The containers are read here, ZSTD and LERC by libraries (tiff-codecs.ts). geotiff (3.0) is not used because it trusts declared sizes,
 * inflates any amount, imports http, fs and vm, which browsers lack, and fetches a data: address for ZSTD, which the page's policy forbids.
 * tiff (7.1) is not used because it lacks the predictor of floats, with which GDAL and tifffile write depth. Not read: JPEG data, palettes.
 */
import { badFile } from "../../errors.js";
import { inflateExactly } from "../../inflate.js";
import { turnedBy } from "./exif.js";
import { half } from "../../half.js";
import { OVERHEAD, checkSize } from "./limits.js";
import type { Picture } from "./picture.js";
import { lzw, packBits, undoFloats, undoIntegers } from "./tiff-coding.js";
import { warning } from "../warnings.js";

/** Largest number of bytes of all pixels. */
const MOST_PIXELS = 2 ** 28;

const Tag = {
  ...{
    Width: 256,
    Height: 257,
    Bits: 258,
    Compression: 259,
    Photometric: 262,
    Offsets: 273,
    Orientation: 274,
    Samples: 277,
    Rows: 278,
  },
  ...{
    Counts: 279,
    Planes: 284,
    Predictor: 317,
    TileWidth: 322,
    TileHeight: 323,
    TileOffsets: 324,
    TileCounts: 325,
    Format: 339,
    Lerc: 50674,
  },
} as const;

/** Bytes of a value of each of TIFF's types that are numbers here. */
const TYPES: Record<number, number> = { 1: 1, 3: 2, 4: 4, 16: 8 };
const MOST_TAGS = 1000;
const MOST_VALUES = 200_000;

type Tags = Map<number, number[]>;

function directory(view: DataView): { tags: Tags; little: boolean; hasMore: boolean } {
  const little = view.getUint16(0) === 0x4949;
  const kind = view.getUint16(2, little);
  if (kind !== 42 && kind !== 43) throw badFile("this TIFF has an unknown version");
  const isBig = kind === 43;
  const whole = (at: number) => (isBig ? Number(view.getBigUint64(at, little)) : view.getUint32(at, little));
  const number = (at: number, size: number) =>
    size === 1
      ? view.getUint8(at)
      : size === 2
        ? view.getUint16(at, little)
        : size === 4
          ? view.getUint32(at, little)
          : Number(view.getBigUint64(at, little));
  const at = whole(isBig ? 8 : 4);
  const count = isBig ? whole(at) : view.getUint16(at, little);
  if (count === 0 || count > MOST_TAGS) throw badFile(`this TIFF has ${count} tags; 1 to ${MOST_TAGS} are supported`);
  const [first, step, room] = isBig ? [at + 8, 20, 8] : [at + 2, 12, 4];
  const tags: Tags = new Map();
  for (let index = 0; index < count; index++) {
    const entry = first + step * index;
    const size = TYPES[view.getUint16(entry + 2, little)];
    const length = whole(entry + 4);
    if (size === undefined || length > MOST_VALUES) continue;
    const place = entry + 4 + room;
    const from = size * length <= room ? place : whole(place);
    tags.set(
      view.getUint16(entry, little),
      Array.from({ length }, (_, each) => number(from + size * each, size)),
    );
  }
  const next = first + step * count;
  return {
    tags,
    little,
    hasMore: next + room <= view.byteLength && (isBig ? whole(next) : view.getUint32(next, little)) > 0,
  };
}

interface Layout {
  width: number;
  height: number;
  samples: number;
  bits: number;
  isFloat: boolean;
  isSigned: boolean;
  compression: number;
  /** The second compression of LERC data. */
  again: number;
  predictor: number;
  /** Whether each channel has separate strips or tiles. */
  isApart: boolean;
  isTiled: boolean;
  /** The size of a tile; a strip is a tile as wide as the picture. */
  tileWidth: number;
  tileHeight: number;
  offsets: number[];
  counts: number[];
}

function layout(tags: Tags): Layout {
  const one = (tag: number, missing: number): number => tags.get(tag)?.[0] ?? missing;
  const [width, height] = [one(Tag.Width, 0), one(Tag.Height, 0)];
  checkSize(width, height);
  const [samples, bits, format] = [one(Tag.Samples, 1), one(Tag.Bits, 1), one(Tag.Format, 1)];
  const isFloat = format === 3;
  if (tags.get(Tag.Bits)?.some((each) => each !== bits)) throw badFile("this TIFF has channels of different sizes");
  const known = isFloat ? [16, 32, 64] : [8, 16, 32];
  if (!known.includes(bits) || format > 3)
    throw badFile(
      `this TIFF has ${bits}-bit samples of format ${format}; 8, 16 and 32 bits, or floats of 16, 32 and 64, are supported`,
    );
  if (samples < 1 || samples > 4) throw badFile(`this TIFF has ${samples} channels; 1 to 4 are supported`);
  if (one(Tag.Photometric, 1) === 3) throw badFile("this TIFF has a palette, which is not supported; save it as PNG");
  if ((width * height * samples * bits) / 8 > MOST_PIXELS)
    throw badFile(`this TIFF has ${width}x${height} pixels of ${samples} times ${bits} bits, which is too large`);
  const isTiled = tags.has(Tag.TileWidth);
  const [tileWidth, tileHeight] = isTiled
    ? [one(Tag.TileWidth, 0), one(Tag.TileHeight, 0)]
    : [width, Math.min(height, one(Tag.Rows, height))];
  if (isTiled) checkSize(tileWidth, tileHeight);
  if (tileHeight < 1) throw badFile("this TIFF has strips without rows");
  const isApart = one(Tag.Planes, 1) !== 1 && samples > 1;
  const each = Math.ceil(width / tileWidth) * Math.ceil(height / tileHeight);
  const needed = isApart ? each * samples : each;
  const [offsets = [], counts = []] = [
    tags.get(isTiled ? Tag.TileOffsets : Tag.Offsets),
    tags.get(isTiled ? Tag.TileCounts : Tag.Counts),
  ];
  if (offsets.length < needed || counts.length < needed)
    throw badFile(`this TIFF lists ${offsets.length} strips or tiles; ${needed} are needed`);
  const rest = {
    isFloat,
    isSigned: format === 2,
    compression: one(Tag.Compression, 1),
    again: tags.get(Tag.Lerc)?.[1] ?? 0,
    predictor: one(Tag.Predictor, 1),
    isApart,
  };
  // Tiles at the edges are padded; all tiles together may be only little larger than the picture.
  if (isTiled && each * tileWidth * tileHeight > 4 * width * height + 4 * tileWidth * tileHeight)
    throw badFile("this TIFF has tiles much larger than its picture");
  return { width, height, samples, bits, ...rest, isTiled, tileWidth, tileHeight, offsets, counts };
}

const COMPRESSIONS: Record<number, string> = {
  2: "CCITT",
  3: "CCITT",
  4: "CCITT",
  6: "JPEG",
  7: "JPEG",
  34925: "LZMA",
  50001: "WebP",
};
const [ZSTD, LERC] = [50000, 34887];

type Codecs = typeof import("./tiff-codecs.js");

/** The bytes of one strip or tile, exactly `length` of them. */
function expanded(bytes: Uint8Array, { compression, again }: Layout, length: number, codecs?: Codecs): Uint8Array {
  if (compression === 1) {
    if (bytes.length < length)
      throw badFile(`this TIFF is cut off: one of its strips or tiles has ${bytes.length} of ${length} bytes`);
    return bytes.slice(0, length);
  }
  if (bytes.length > 2 * length + OVERHEAD)
    throw badFile("this TIFF is damaged: one of its compressed strips or tiles is longer than the raw one");
  if (compression === 5) return lzw(bytes, length);
  if (compression === 8 || compression === 32946) return inflateExactly(bytes, length, "this TIFF");
  if (compression === 32773) return packBits(bytes, length);
  if (compression === ZSTD && codecs) return codecs.unpackZstd(bytes, length);
  if (compression === LERC && codecs) return codecs.unpackLerc(bytes, length, again);
  throw badFile(
    `this TIFF is compressed with ${COMPRESSIONS[compression] ?? `method ${compression}`}, which is not supported; save it uncompressed, or with LZW or deflate`,
  );
}

/** Interleaves channels that are stored separately. */
function joined(bytes: Uint8Array, found: Layout, little: boolean, codecs?: Codecs): Uint8Array {
  const { width, height, samples, bits, offsets, counts } = found;
  const [size, each] = [bits / 8, Math.floor(offsets.length / samples)];
  const out = new Uint8Array(width * height * samples * size);
  for (let channel = 0; channel < samples; channel++) {
    const own = (list: number[]) => list.slice(channel * each, (channel + 1) * each);
    const one = { ...found, samples: 1, isApart: false, offsets: own(offsets), counts: own(counts) };
    const plane = pixels(bytes, one, little, codecs);
    for (let at = 0; at < plane.length; at++)
      out[(Math.floor(at / size) * samples + channel) * size + (at % size)] = plane[at] ?? 0;
  }
  return out;
}

/** All samples, as bytes in the order of this machine. */
function pixels(bytes: Uint8Array, found: Layout, little: boolean, codecs?: Codecs): Uint8Array {
  if (found.isApart) return joined(bytes, found, little, codecs);
  const { width, height, samples, bits, isTiled, tileWidth, tileHeight, offsets, counts, predictor } = found;
  const size = (bits / 8) * samples;
  const out = new Uint8Array(width * height * size);
  const across = Math.ceil(width / tileWidth);
  for (let row = 0; row < height; row += tileHeight) {
    // The last strip has only the remaining rows; the last tile is padded.
    const rows = isTiled ? tileHeight : Math.min(tileHeight, height - row);
    for (let column = 0; column < width; column += tileWidth) {
      const index = Math.floor(row / tileHeight) * across + Math.floor(column / tileWidth);
      const from = offsets[index] ?? 0;
      const until = from + (counts[index] ?? 0);
      if (until > bytes.length) throw badFile(`this TIFF is cut off: ${bytes.length} of ${until} bytes`);
      const part = expanded(bytes.subarray(from, until), found, rows * tileWidth * size, codecs);
      if (predictor === 3) undoFloats(part, tileWidth * samples, bits / 8, samples);
      else if (found.compression !== LERC) swap(part, bits / 8, little);
      if (predictor === 2) undoIntegers(part, tileWidth, bits / 8, samples);
      const used = Math.min(tileWidth, width - column) * size;
      for (let line = 0; line < Math.min(rows, height - row); line++) {
        out.set(
          part.subarray(line * tileWidth * size, line * tileWidth * size + used),
          ((row + line) * width + column) * size,
        );
      }
    }
  }
  return out;
}

/** Converts bytes to little-endian order, in place. */
function swap(part: Uint8Array, size: number, little: boolean): void {
  if (little || size === 1) return;
  for (let at = 0; at + size <= part.length; at += size) part.subarray(at, at + size).reverse();
}

const MORE = warning("file-left-out", "The file holds several pictures; only the first was read.");

export function readTiff(bytes: Uint8Array): Picture | Promise<Picture> {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  const { tags, little, hasMore } = directory(view);
  const found = layout(tags);
  if (![1, 2, 3].includes(found.predictor) || (found.predictor === 3 && !found.isFloat))
    throw badFile(`this TIFF has the predictor ${found.predictor}, which is not supported`);
  const picture = (codecs?: Codecs) =>
    turnedBy(
      { ...asPicture(pixels(bytes, found, little, codecs), found), warnings: hasMore ? [MORE] : [] },
      tags.get(Tag.Orientation)?.[0] ?? 1,
      "its tag says",
    );
  if (found.compression !== ZSTD && found.compression !== LERC) return picture();
  return import("./tiff-codecs.js").then(picture);
}

/** Converts samples to the types of pictures. */
function asPicture(samples: Uint8Array, found: Layout): Picture {
  const { buffer } = samples as Uint8Array<ArrayBuffer>;
  const { width, height, samples: channels, bits, isFloat, isSigned } = found;
  const data = isFloat
    ? bits === 64
      ? new Float32Array(new Float64Array(buffer))
      : bits === 16
        ? Float32Array.from(new Uint16Array(buffer), half)
        : new Float32Array(buffer)
    : bits === 8
      ? new Uint8Array(buffer)
      : bits === 32
        ? new Float32Array(isSigned ? new Int32Array(buffer) : new Uint32Array(buffer))
        : isSigned
          ? new Uint16Array(new Int16Array(buffer).map((value) => Math.max(0, value)))
          : new Uint16Array(buffer);
  return { width, height, channels, data, format: "TIFF", bits, notes: [], warnings: [] };
}
