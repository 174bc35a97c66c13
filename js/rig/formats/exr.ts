/**
 * OpenEXR of one part in scan lines, plain or by RLE, ZIPS or ZIP: half, float and whole numbers.
 *
 * PIZ, PXR24 and the colours of DWA are parse-exr's (exr-others.ts). It does not replace this: it knows neither a channel Z nor whole
 * numbers, mistakes channels of different types, and checks nothing of what a file declares. B44 is in exr-b44.ts, what DWA keeps without
 * loss in exr-dwa.ts. Not read: tiles, deep pixels, several parts; each is named.
 */
import { badFile } from "../../errors.js";
import { inflateExactly } from "../../inflate.js";
import {
  B44,
  B44A,
  type Channel,
  DWAA,
  type Header,
  SIZES,
  blocks,
  isKept,
  readHeader,
  strideOf,
} from "./exr-header.js";
import { half } from "../../half.js";
import type { Picture } from "./picture.js";
import { warning } from "../warnings.js";

/** The last compression that is read here. */
const ZIP = 3;
/** Bytes of all channels, used or not. */
const MOST_PIXELS = 2 ** 28;

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

const LOSSY = warning(
  "eight-bits",
  "Halves by B44 and colours by DWA are compressed with loss: beside holes and edges depths are up to a tenth off. Save the depth map by ZIP.",
);

export function readExr(bytes: Uint8Array, isDepth: boolean): Picture | Promise<Picture> {
  const found = readHeader(bytes);
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
  const [only = 0, ...more] = used;
  const isKeptWhole =
    compression >= DWAA && more.length === 0 && channels[only] !== undefined && isKept(channels[only]);
  return import("./exr-others.js").then(({ readB44, readKept, readOthers }) => {
    if (isKeptWhole) return picture(readKept(bytes, found, only));
    const isB44 = compression === B44 || compression === B44A;
    const isLossy = isB44 ? more.length === 0 && bits === 16 : isDepth && compression >= DWAA;
    const data = isB44 ? readB44(bytes, found, used) : readOthers(bytes, found, used);
    return { ...picture(data), warnings: isLossy ? [LOSSY] : [] };
  });
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
