/**
 * The channels of an OpenEXR that DWA compresses without loss: all but colours and alpha, such as Z, V and Depth.
 *
 * A block begins with eleven integers of 64 bits and the rules that assign a scheme to each channel. The lossless channels follow, deflated,
 * one after the other.
 */
import { badFile } from "../../errors.js";
import { inflateExactly } from "../../inflate.js";
import { type Channel, type Header, SIZES, blocks, isKept } from "./exr-header.js";
import { channelOfLines, samplesOf } from "./exr-samples.js";

/** Bytes of the integers at the beginning of a block. */
const NUMBERS = 88;
/** The scheme of channels that are compressed without loss. */
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
    if (end < 0 || end + 2 >= until) throw badFile("this EXR is damaged: a block has invalid channel rules");
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

/** The samples of one channel in a block as bytes, line by line. */
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
      "this EXR (DWAA or DWAB) is damaged or stores its depths in an unsupported way; save it with ZIP compression",
    );
  return inflateExactly(body.subarray(start, start + packed), length, "this EXR").subarray(before, before + size(own));
}

export function readKept(bytes: Uint8Array, header: Header, used: number): Float32Array {
  const { width, height, lines, channels } = header;
  const type = channels[used]?.type ?? 0;
  const data = new Float32Array(width * height).fill(NaN);
  for (const { row, body, length } of blocks(bytes, header)) {
    const rows = Math.min(lines, height - row);
    // A block that compression would not shorten is stored as it is.
    const isStored = body.length >= length;
    const found = isStored
      ? channelOfLines(body, header, used, rows)
      : samplesOf(plane(body, header, used, rows), type);
    data.set(found, row * width);
  }
  return data;
}
