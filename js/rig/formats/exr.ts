/**
 * OpenEXR of one part in scan lines, plain or by RLE, ZIPS or ZIP: half, float and whole numbers.
 *
 * PIZ, PXR24 and DWA are parse-exr's (exr-others.ts). It does not replace this: it knows neither a channel Z nor whole numbers, mistakes
 * channels of different types, and checks nothing of what a file declares. Not read: B44, tiles, deep pixels, several parts; each is named.
 */
import { badFile } from "../../errors.js";
import { inflateExactly } from "../../inflate.js";
import { half } from "./half.js";
import { checkSize } from "./limits.js";
import type { Picture } from "./picture.js";

const COMPRESSIONS = ["none", "RLE", "ZIPS", "ZIP", "PIZ", "PXR24", "B44", "B44A", "DWAA", "DWAB"];
/** Lines of a block, of those that are read. */
const LINES: Record<number, number> = { 0: 1, 1: 1, 2: 1, 3: 16, 4: 32, 5: 16, 8: 32, 9: 256 };
/** The last compression that is read here. */
const ZIP = 3;
const SIZES = [4, 2, 4];
const MOST_CHANNELS = 64;
const MOST_HEADER = 65_536;
/** Bytes of all channels, used or not. */
const MOST_PIXELS = 2 ** 28;

export interface Channel {
  name: string;
  type: number;
}

export interface Header {
  width: number;
  height: number;
  top: number;
  compression: number;
  /** Lines of a block. */
  lines: number;
  channels: Channel[];
  end: number;
}

/** Text up to a zero; where the next thing begins. */
function word(bytes: Uint8Array, at: number): [string, number] {
  const end = bytes.subarray(at, at + 256).indexOf(0);
  if (end < 0) throw badFile("this EXR is damaged: a name in its header has no end");
  return [String.fromCharCode(...bytes.subarray(at, at + end)), at + end + 1];
}

function channelList(view: DataView, bytes: Uint8Array, from: number, until: number): Channel[] {
  const found: Channel[] = [];
  for (let at = from; at < until && bytes[at] !== 0; ) {
    const [name, next] = word(bytes, at);
    const type = view.getInt32(next, true);
    if (SIZES[type] === undefined) throw badFile(`this EXR has a channel of type ${type}, which there is not`);
    if (view.getInt32(next + 8, true) !== 1 || view.getInt32(next + 12, true) !== 1)
      throw badFile("this EXR has channels of fewer pixels than the picture");
    found.push({ name, type });
    if (found.length > MOST_CHANNELS) throw badFile(`this EXR has more than ${MOST_CHANNELS} channels`);
    at = next + 16;
  }
  return found;
}

function header(view: DataView, bytes: Uint8Array): Header {
  const flags = view.getUint32(4, true);
  if (flags & 0x1a00)
    throw badFile(
      `this EXR is ${flags & 0x200 ? "tiled" : flags & 0x800 ? "deep" : "of several parts"}, which is not read here; save it as plain scan lines`,
    );
  const found: Header = { width: 0, height: 0, top: 0, compression: -1, lines: 0, channels: [], end: 0 };
  let at = 8;
  while (bytes[at] !== 0) {
    const [name, afterName] = word(bytes, at);
    const [, afterType] = word(bytes, afterName);
    const size = view.getInt32(afterType, true);
    const body = afterType + 4;
    if (size < 0 || body + size > Math.min(bytes.length, MOST_HEADER))
      throw badFile("this EXR is cut off or damaged in its header");
    if (name === "channels") found.channels = channelList(view, bytes, body, body + size);
    if (name === "compression") found.compression = view.getUint8(body);
    if (name === "dataWindow") {
      const [left, top, right, bottom] = [0, 4, 8, 12].map((offset) => view.getInt32(body + offset, true));
      found.width = (right ?? 0) - (left ?? 0) + 1;
      found.height = (bottom ?? 0) - (top ?? 0) + 1;
      found.top = top ?? 0;
    }
    at = body + size;
  }
  found.end = at + 1;
  checkSize(found.width, found.height);
  if (found.channels.length === 0) throw badFile("this EXR has no channels");
  const lines = LINES[found.compression];
  if (lines === undefined)
    throw badFile(
      `this EXR is compressed by ${COMPRESSIONS[found.compression] ?? "an unknown method"}, which is not read here; save it by ZIP`,
    );
  found.lines = lines;
  return found;
}

function runs(bytes: Uint8Array, length: number): Uint8Array {
  const out = new Uint8Array(length);
  let made = 0;
  for (let at = 0; made < length; ) {
    const head = bytes[at++];
    if (head === undefined || at >= bytes.length)
      throw badFile(`this EXR is cut off: a block has ${made} of ${length} bytes`);
    const count = head < 128 ? head + 1 : 256 - head;
    for (let index = 0; index < count && made < length; index++) out[made++] = bytes[head < 128 ? at : at + index] ?? 0;
    at += head < 128 ? 1 : count;
  }
  return out;
}

/** Bytes are differences, those of even places first and those of odd ones behind. */
function restored(data: Uint8Array): Uint8Array {
  for (let at = 1; at < data.length; at++) data[at] = (data[at - 1] ?? 0) + (data[at] ?? 0) - 128;
  const out = new Uint8Array(data.length);
  const half = Math.ceil(data.length / 2);
  for (let at = 0; at < data.length; at++) out[at] = data[(at & 1 ? half : 0) + (at >> 1)] ?? 0;
  return out;
}

/** Which channels make the picture: red, green and blue, or the one that holds depth. */
function chosen(channels: Channel[], isDepth: boolean): number[] {
  const find = (...names: string[]) =>
    channels.findIndex(({ name }) => names.includes((name.split(".").at(-1) ?? "").toUpperCase()));
  const colours = [find("R"), find("G"), find("B")];
  const depth = find("Z", "V", "DEPTH");
  if (isDepth && depth >= 0) return [depth];
  if (colours.every((index) => index >= 0)) return colours;
  if (channels.length === 1) return [0];
  const single = depth >= 0 ? depth : find("Y");
  if (single < 0)
    throw badFile(
      `this EXR has the channels ${channels
        .map(({ name }) => name)
        .slice(0, 8)
        .join(", ")}; R, G, B, or Z, or one alone, are read`,
    );
  return [single];
}

const strideOf = ({ width, channels }: Header): number =>
  width * channels.reduce((sum, { type }) => sum + (SIZES[type] ?? 0), 0);

/** Where the blocks are: their first lines, what the file has of them, and the bytes that this becomes. */
export function blocks(bytes: Uint8Array, header: Header): { row: number; body: Uint8Array; length: number }[] {
  const { height, top, lines, end } = header;
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  return Array.from({ length: Math.ceil(height / lines) }, (_, block) => {
    const at = Number(view.getBigUint64(end + 8 * block, true));
    const row = view.getInt32(at, true) - top;
    const size = view.getInt32(at + 4, true);
    if (row < 0 || row >= height || size < 0 || at + 8 + size > bytes.length)
      throw badFile(`this EXR is cut off or damaged in its block ${block}`);
    const length = Math.min(lines, height - row) * strideOf(header);
    if (size > 2 * length + 1024) throw badFile(`this EXR is damaged: its block ${block} is too long`);
    return { row, body: bytes.subarray(at + 8, at + 8 + size), length };
  });
}

/** The samples of the chosen channels. */
function readKnown(bytes: Uint8Array, header: Header, used: number[]): Float32Array {
  const { width, height, channels, compression } = header;
  const stride = strideOf(header);
  const data = new Float32Array(width * height * used.length).fill(NaN);
  blocks(bytes, header).forEach(({ row, body, length }, block) => {
    const plain =
      body.length === length || compression === 0
        ? body
        : restored(compression === 1 ? runs(body, length) : inflateExactly(body, length, "this EXR"));
    if (plain.length < length)
      throw badFile(`this EXR is cut off: its block ${block} has ${plain.length} of ${length} bytes`);
    spread(plain, { width, rows: length / stride, row, channels, used, stride }, data);
  });
  return data;
}

export function readExr(bytes: Uint8Array, isDepth: boolean): Picture | Promise<Picture> {
  const found = header(new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength), bytes);
  const { width, height, channels, compression } = found;
  const used = chosen(channels, isDepth);
  if (strideOf(found) * height > MOST_PIXELS)
    throw badFile(`this EXR has ${width}x${height} pixels of ${channels.length} channels, which is too much`);
  const bits = channels[used[0] ?? 0]?.type === 1 ? 16 : 32;
  const picture = (data: Float32Array): Picture => ({
    ...{ width, height, channels: used.length, data },
    ...{ format: "EXR", bits, notes: [], warnings: [] },
  });
  if (compression <= ZIP) return picture(readKnown(bytes, found, used));
  return import("./exr-others.js").then(({ readOthers }) => picture(readOthers(bytes, found, used)));
}

interface Block {
  width: number;
  rows: number;
  row: number;
  channels: Channel[];
  used: number[];
  stride: number;
}

/** A line has all values of its first channel, then all of its second. */
function spread(plain: Uint8Array, { width, rows, row, channels, used, stride }: Block, data: Float32Array): void {
  const view = new DataView(plain.buffer, plain.byteOffset, plain.byteLength);
  for (let line = 0; line < rows; line++) {
    let from = line * stride;
    channels.forEach(({ type }, index) => {
      const size = SIZES[type] ?? 0;
      const channel = used.indexOf(index);
      for (let column = 0; channel >= 0 && column < width; column++) {
        const at = from + column * size;
        const value =
          type === 1
            ? half(view.getUint16(at, true))
            : type === 2
              ? view.getFloat32(at, true)
              : view.getUint32(at, true);
        data[((row + line) * width + column) * used.length + channel] = value;
      }
      from += width * size;
    });
  }
}
