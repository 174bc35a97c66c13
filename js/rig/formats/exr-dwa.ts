/**
 * Channels of an OpenEXR by DWA that it keeps without loss: all but colours and alpha, such as Z, V and Depth.
 *
 * A block begins with eleven numbers of 64 bits and the rules by which channels are told apart; what is kept without loss follows,
 * deflated, one channel after the other.
 */
import { badFile } from "../../errors.js";
import { inflateExactly } from "../../inflate.js";
import { type Channel, type Header, SIZES, blocks, isKept } from "./exr-header.js";
import { half } from "../../half.js";

/** Bytes of the numbers at the beginning of a block. */
const NUMBERS = 88;
/** Of a rule: how the channel is compressed. */
const UNKNOWN = 0;

interface Rule {
  suffix: string;
  scheme: number;
  type: number;
  anyCase: boolean;
}

function rulesOf(body: Uint8Array, until: number): Rule[] {
  const found: Rule[] = [];
  for (let at = NUMBERS + 2; at < until; ) {
    const end = body.indexOf(0, at);
    if (end < 0 || end + 2 >= until) throw badFile("this EXR is damaged in the rules of a block");
    const flags = body[end + 1] ?? 0;
    const suffix = String.fromCharCode(...body.subarray(at, end));
    found.push({ suffix, scheme: (flags >> 2) & 3, anyCase: (flags & 1) === 1, type: body[end + 2] ?? 0 });
    at = end + 3;
  }
  return found;
}

function schemeOf({ name, type }: Channel, rules: Rule[]): number {
  const suffix = name.slice(name.lastIndexOf(".") + 1);
  const same = (rule: Rule) =>
    rule.anyCase ? rule.suffix.toLowerCase() === suffix.toLowerCase() : rule.suffix === suffix;
  return rules.find((rule) => rule.type === type && same(rule))?.scheme ?? UNKNOWN;
}

/** The samples of one channel in a block, as bytes line by line. */
function plane(body: Uint8Array, header: Header, used: number, rows: number): Uint8Array {
  const { width, channels } = header;
  const view = new DataView(body.buffer, body.byteOffset, body.byteLength);
  const number = (index: number) => Number(view.getBigUint64(8 * index, true));
  const [version, length, packed] = [number(0), number(1), number(2)];
  const start = version >= 2 ? NUMBERS + view.getUint16(NUMBERS, true) : NUMBERS;
  const rules = version >= 2 ? rulesOf(body, start) : [];
  const isUnknown = (channel: Channel) => (version >= 2 ? schemeOf(channel, rules) === UNKNOWN : isKept(channel));
  const size = ({ type }: Channel) => width * rows * (SIZES[type] ?? 0);
  const before = channels
    .slice(0, used)
    .filter(isUnknown)
    .reduce((sum, each) => sum + size(each), 0);
  const own = channels[used] as Channel;
  const all = channels.filter(isUnknown).reduce((sum, each) => sum + size(each), 0);
  if (!isUnknown(own) || length !== all || start + packed > body.length)
    throw badFile(
      "this EXR by DWA (DWAA or DWAB) keeps its depths in a way that is not read here, or is damaged; save it by ZIP",
    );
  return inflateExactly(body.subarray(start, start + packed), length, "this EXR").subarray(before, before + size(own));
}

/** A block that did not become shorter is stored as it is: each line has all of its channels. */
function storedPlane(body: Uint8Array, { width, channels }: Header, used: number, rows: number): Uint8Array {
  const sizes = channels.map(({ type }) => width * (SIZES[type] ?? 0));
  const stride = sizes.reduce((sum, size) => sum + size, 0);
  const before = sizes.slice(0, used).reduce((sum, size) => sum + size, 0);
  const own = sizes[used] ?? 0;
  const out = new Uint8Array(own * rows);
  for (let row = 0; row < rows; row++)
    out.set(body.subarray(row * stride + before, row * stride + before + own), row * own);
  return out;
}

export function readKept(bytes: Uint8Array, header: Header, used: number): Float32Array {
  const { width, height, lines, channels } = header;
  const type = channels[used]?.type ?? 0;
  const data = new Float32Array(width * height).fill(NaN);
  for (const { row, body, length } of blocks(bytes, header)) {
    const rows = Math.min(lines, height - row);
    const found = body.length >= length ? storedPlane(body, header, used, rows) : plane(body, header, used, rows);
    const view = new DataView(found.buffer, found.byteOffset, found.byteLength);
    for (let at = 0; at < width * rows; at++)
      data[row * width + at] =
        type === 1
          ? half(view.getUint16(2 * at, true))
          : type === 2
            ? view.getFloat32(4 * at, true)
            : view.getUint32(4 * at, true);
  }
  return data;
}
