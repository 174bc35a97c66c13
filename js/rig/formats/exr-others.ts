/**
 * OpenEXR compressed with PIZ, PXR24 or DWA, read by parse-exr. This module is loaded with the first such file.
 *
 * parse-exr trusts what a file declares and supports only the channels R, G, B, A and Y. It therefore gets a file that is made here, with the
 * attributes that it needs, checked blocks in order, and the wanted channels under these names. Limits: PIZ and DWA with channels of different
 * types, which parse-exr misreads, and DWA of other channels than R, G, B and Y, whose blocks contain the names; exr-dwa.ts reads the lossless
 * ones.
 */
import parseExr from "parse-exr";
import { badFile } from "../../errors.js";
import { inflateUpTo } from "../../inflate.js";
import { COMPRESSIONS, type Header, blocks } from "./exr-header.js";
import { WHOLE } from "./exr-samples.js";

export { readB44 } from "./exr-b44.js";
export { readKept } from "./exr-dwa.js";

/** The number of the float type in three.js, which parse-exr expects. */
const FLOAT = 1015;
const MOST_CHANNELS = 16;
const [PXR24, DWAA, DWAB] = [5, 8, 9];
/** Little-endian numbers of four bytes. */
const words = (...values: number[]): Uint8Array => new Uint8Array(new Int32Array(values).buffer);
const text = (value: string): Uint8Array => new TextEncoder().encode(value);

const joined = (parts: Uint8Array[]): Uint8Array<ArrayBuffer> => {
  const out = new Uint8Array(parts.reduce((sum, part) => sum + part.length, 0));
  let at = 0;
  for (const part of parts) {
    out.set(part, at);
    at += part.length;
  }
  return out;
};

const attribute = (name: string, type: string, body: Uint8Array): Uint8Array[] => [
  text(`${name}\0${type}\0`),
  words(body.length),
  body,
];

/** Names of the channels for parse-exr. The chosen channels get names that it supports, the others do not. */
function names({ channels, compression }: Header, used: number[]): string[] {
  const known = used.length === 1 ? ["Y"] : ["R", "G", "B"];
  const given = channels.map(({ name }, index) => known[used.indexOf(index)] ?? `other ${name}`);
  const isDwa = compression === DWAA || compression === DWAB;
  if (isDwa && channels.some(({ name }, index) => used.includes(index) && name !== given[index]))
    throw badFile(
      "this EXR is compressed with DWA (DWAA or DWAB), which is supported only for R, G and B together, for Y, or for one channel of another name; save it with ZIP compression",
    );
  return isDwa ? channels.map(({ name }) => name) : given;
}

/** Checks that the parts of a DWA block do not inflate to more than they declare; parse-exr would inflate any amount. */
function checkDwa(body: Uint8Array, length: number): void {
  const view = new DataView(body.buffer, body.byteOffset, body.byteLength);
  const at = (index: number) => Number(view.getBigUint64(8 * index, true));
  const [unknown, ac, dc, rle, rleRaw, acCount, dcCount, method] = [2, 3, 4, 5, 7, 8, 9, 10].map(at) as [
    ...[number, number, number, number],
    ...[number, number, number, number],
  ];
  if (unknown > 0 || (ac > 0 && method !== 0))
    throw badFile(
      "this EXR is compressed with an unsupported kind of DWA (DWAA or DWAB); save it with ZIP compression",
    );
  const start = 88 + view.getUint16(88, true);
  if (Math.max(2 * acCount, 2 * dcCount, rleRaw) > 2 * length || start + ac + dc + rle > body.length)
    throw badFile("this EXR is damaged: one of its blocks declares more than the picture has");
  if (dc > 0) inflateUpTo(body.subarray(start + ac, start + ac + dc), 2 * dcCount, "this EXR");
  if (rle > 0) inflateUpTo(body.subarray(start + ac + dc, start + ac + dc + rle), 2 * length, "this EXR");
}

function checkBlock(body: Uint8Array, length: number, { compression }: Header): void {
  // A block that compression would not shorten is stored as it is.
  if (body.length >= length) {
    if (body.length > length)
      throw badFile("this EXR is damaged: one of its compressed blocks is longer than the raw one");
  } else if (compression === PXR24) inflateUpTo(body, length, "this EXR");
  else if (compression === DWAA || compression === DWAB) checkDwa(body, length);
}

/** A file with only what parse-exr needs. */
function plainFile(bytes: Uint8Array, header: Header, given: string[]): ArrayBuffer {
  const { width, height, top, channels, compression } = header;
  const list = channels.flatMap(({ type }, index) => [text(`${given[index]}\0`), words(type, 0, 1, 1)]);
  const head = joined([
    words(20_000_630, 2),
    ...attribute("channels", "chlist", joined([...list, text("\0")])),
    ...attribute("compression", "compression", new Uint8Array([compression])),
    ...attribute("dataWindow", "box2i", words(0, top, width - 1, top + height - 1)),
    ...attribute("lineOrder", "lineOrder", new Uint8Array([0])),
    text("\0"),
  ]);
  const found = blocks(bytes, header).sort((a, b) => a.row - b.row);
  found.forEach(({ row, body, length }, index) => {
    if (row !== index * header.lines) throw badFile("this EXR is damaged: one of its blocks is missing");
    checkBlock(body, length, header);
  });
  const body = found.flatMap(({ row, body }) => [words(top + row, body.length), body]);
  // parse-exr skips the table of offsets and reads the blocks one after the other.
  return joined([head, new Uint8Array(8 * found.length), ...body]).buffer;
}

/** The pixels by parse-exr, which throws a TypeError for DWA blocks whose luminance it takes for colours. */
function parsed(file: ArrayBuffer, compression: number) {
  try {
    return parseExr(file, FLOAT);
  } catch (error) {
    const isOwn = error instanceof TypeError && (compression === DWAA || compression === DWAB);
    if (!isOwn) throw error;
    throw badFile(
      "this EXR (DWAA or DWAB) is damaged or compressed in an unsupported way; save it with ZIP compression",
      error,
    );
  }
}

export function readOthers(bytes: Uint8Array, header: Header, used: number[]): Float32Array {
  const { width, height, channels, compression } = header;
  const types = new Set(
    (compression === PXR24 ? channels.filter((_, at) => used.includes(at)) : channels).map(({ type }) => type),
  );
  if (channels.length > MOST_CHANNELS)
    throw badFile(`this EXR has ${channels.length} channels; up to ${MOST_CHANNELS} are supported`);
  if (types.size > 1 || channels.some(({ type }) => type === WHOLE))
    throw badFile(
      `this EXR is compressed with ${COMPRESSIONS[compression] ?? "PIZ"}, which is not supported for integers or mixed types; save it with ZIP compression`,
    );
  const { data } = parsed(plainFile(bytes, header, names(header, used)), compression);
  const step = used.length === 1 ? 1 : 4;
  const out = new Float32Array(width * height * used.length);
  // parse-exr puts the lowest line first.
  for (let row = 0, to = 0; row < height; row++)
    for (let column = 0; column < width; column++)
      for (let channel = 0; channel < used.length; channel++)
        out[to++] = data[((height - 1 - row) * width + column) * step + channel] ?? NaN;
  return out;
}
