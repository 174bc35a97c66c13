/**
 * OpenEXR of one part in scan lines, uncompressed or compressed with RLE, ZIPS or ZIP: halves, floats and integers.
 *
 * PIZ, PXR24 and the colours of DWA are read by parse-exr (exr-others.ts). It does not replace this reader: it supports neither a channel Z
 * nor integers, misreads channels of different types, and does not check what a file declares. B44 is in exr-b44.ts, and the lossless channels
 * of DWA are in exr-dwa.ts. Limits: tiles, deep pixels and files of several parts are refused, each by name.
 */
import { badFile } from "../../errors.js";
import { inflateExactly } from "../../inflate.js";
import { B44, B44A, type Channel, DWAA, type Header, blocks, isKept, readHeader, strideOf } from "./exr-header.js";
import { HALF, channelOfLines, interleave } from "./exr-samples.js";
import type { Picture } from "./picture.js";
import { warning } from "../warnings.js";

/** The largest number of a compression that this file reads. */
const ZIP = 3;
/** Largest number of bytes of all channels, including unused ones. */
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

/** Undoes the predictor: bytes are differences, those at even places first and those at odd places second. */
function restored(data: Uint8Array): Uint8Array {
  for (let at = 1; at < data.length; at++) data[at] = (data[at - 1] ?? 0) + (data[at] ?? 0) - 128;
  const out = new Uint8Array(data.length);
  const half = Math.ceil(data.length / 2);
  for (let at = 0; at < data.length; at++) out[at] = data[(at & 1 ? half : 0) + (at >> 1)] ?? 0;
  return out;
}

/** The channels of the picture: red, green and blue, or the one with the depth. */
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
        .join(", ")}; R, G and B, or Z, or a single channel are supported`,
    );
  return [single];
}

/** The samples of the chosen channels. */
function readKnown(bytes: Uint8Array, header: Header, used: number[]): Float32Array {
  const { width, height, compression } = header;
  const stride = strideOf(header);
  const data = new Float32Array(width * height * used.length).fill(NaN);
  blocks(bytes, header).forEach(({ row, body, length }, block) => {
    const plain =
      body.length === length || compression === 0
        ? body
        : restored(compression === 1 ? runs(body, length) : inflateExactly(body, length, "this EXR"));
    if (plain.length < length)
      throw badFile(`this EXR is cut off: its block ${block} has ${plain.length} of ${length} bytes`);
    used.forEach((channel, to) => {
      interleave(channelOfLines(plain, header, channel, length / stride), data, row * width, used.length, to);
    });
  });
  return data;
}

const LOSSY = warning(
  "eight-bits",
  "The depth map has lossy compression (half floats by B44, or colours by DWA): next to holes and edges, depths may be off by a tenth. Save it with ZIP compression.",
);

export function readExr(bytes: Uint8Array, isDepth: boolean): Picture | Promise<Picture> {
  const found = readHeader(bytes);
  const { width, height, channels, compression } = found;
  const used = chosen(channels, isDepth);
  if (strideOf(found) * height > MOST_PIXELS)
    throw badFile(`this EXR has ${width}x${height} pixels of ${channels.length} channels, which is too large`);
  const bits = channels[used[0] ?? 0]?.type === HALF ? 16 : 32;
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
