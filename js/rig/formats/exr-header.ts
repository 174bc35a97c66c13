/** The header of an OpenEXR of one part in scan lines, and where its blocks are. */
import { badFile } from "../../errors.js";
import { checkSize } from "./limits.js";

export const COMPRESSIONS = ["none", "RLE", "ZIPS", "ZIP", "PIZ", "PXR24", "B44", "B44A", "DWAA", "DWAB"];
/** Lines of a block by each compression. */
const LINES: Record<number, number> = { 0: 1, 1: 1, 2: 1, 3: 16, 4: 32, 5: 16, 6: 32, 7: 32, 8: 32, 9: 256 };
/** Numbers of the two compressions by B44, and of the first one by DWA. */
export const [B44, B44A, DWAA] = [6, 7, 8];
/** Bytes of a sample of each type. */
export const SIZES = [4, 2, 4];
const VERSION = 2;
const MOST_CHANNELS = 64;
const MOST_HEADER = 65_536;

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

/** Text up to a zero byte, and where the next item begins. */
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
    if (SIZES[type] === undefined) throw badFile(`this EXR has a channel of the unknown type ${type}`);
    if (view.getInt32(next + 8, true) !== 1 || view.getInt32(next + 12, true) !== 1)
      throw badFile("this EXR has channels with fewer pixels than the picture, which is not supported");
    found.push({ name, type });
    if (found.length > MOST_CHANNELS) throw badFile(`this EXR has more than ${MOST_CHANNELS} channels`);
    at = next + 16;
  }
  return found;
}

export function readHeader(bytes: Uint8Array): Header {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  const flags = view.getUint32(4, true);
  if ((flags & 0xff) > VERSION) throw badFile(`this EXR has the unknown version ${flags & 0xff}`);
  if (flags & 0x1a00)
    throw badFile(
      `this EXR is ${flags & 0x200 ? "tiled" : flags & 0x800 ? "deep" : "in several parts"}, which is not supported; save it as plain scan lines`,
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
      `this EXR is compressed with ${COMPRESSIONS[found.compression] ?? "an unknown method"}, which is not supported; save it with ZIP compression`,
    );
  found.lines = lines;
  return found;
}

/** Bytes of a line of all channels. */
export const strideOf = ({ width, channels }: Pick<Header, "width" | "channels">): number =>
  width * channels.reduce((sum, { type }) => sum + (SIZES[type] ?? 0), 0);

/** The blocks: the first line of each, its bytes in the file, and its number of bytes once uncompressed. */
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

/** Names of colours and alpha, by the default rules of DWA. */
const LOSSY = /^(?:r|red|g|grn|green|b|blu|blue|y|by|ry|a)$/i;

/** Whether DWA keeps this channel without loss. */
export const isKept = ({ name }: Channel): boolean => !LOSSY.test(name.slice(name.lastIndexOf(".") + 1));
