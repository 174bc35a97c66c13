/**
 * OpenEXR by B44 and B44A: halves in blocks of 4x4 pixels, of 14 bytes each or of 3 where they are all alike; other types are stored as
 * they are. A block of lines has one channel after the other. parse-exr does not know it.
 */
import { badFile } from "../../errors.js";
import { half } from "../../half.js";
import { type Channel, type Header, SIZES, blocks } from "./exr-header.js";

const HALF = 1;
/** Pixels on a side of a block, and bytes of one. */
const [SIDE, LONG, FLAT] = [4, 14, 3];
/** The shift of a block that is all alike. */
const ALIKE = 13;

/** The six bits that begin at this bit. */
const six = (body: Uint8Array, at: number, bit: number): number => {
  const from = at + (bit >> 3);
  return ((((body[from] ?? 0) << 8) | (body[from + 1] ?? 0)) >> (10 - (bit & 7))) & 63;
};
/** Halves are stored in an order in which larger ones are larger. */
const restored = (value: number): number => (value & 0x8000 ? value & 0x7fff : ~value & 0xffff);

/** The sixteen halves of a block, as bits, row by row; how many bytes it has. */
function unpack(body: Uint8Array, at: number, out: Uint16Array): number {
  const first = ((body[at] ?? 0) << 8) | (body[at + 1] ?? 0);
  const shift = (body[at + 2] ?? 0) >> 2;
  if (shift >= ALIKE) {
    out.fill(restored(first));
    return FLAT;
  }
  const bias = 32 << shift;
  const step = (bit: number) => (six(body, at, bit) << shift) - bias;
  const raw = new Array<number>(SIDE * SIDE).fill(0);
  raw[0] = first;
  // Down the first column, then along each row, column by column.
  let bit = 22;
  for (let row = 1; row < SIDE; row++, bit += 6) raw[SIDE * row] = (raw[SIDE * (row - 1)] ?? 0) + step(bit);
  for (let column = 1; column < SIDE; column++)
    for (let row = 0; row < SIDE; row++, bit += 6)
      raw[SIDE * row + column] = (raw[SIDE * row + column - 1] ?? 0) + step(bit);
  raw.forEach((value, index) => (out[index] = restored(value & 0xffff)));
  return LONG;
}

/** One channel of a block of lines; where the next one begins. */
function channelOf(
  body: Uint8Array,
  from: number,
  { type }: Channel,
  width: number,
  rows: number,
): [Float32Array, number] {
  const out = new Float32Array(width * rows);
  if (type !== HALF) {
    const end = from + width * rows * (SIZES[type] ?? 0);
    if (end > body.length) throw badFile("this EXR by B44 is cut off or damaged");
    const view = new DataView(body.buffer, body.byteOffset + from);
    for (let at = 0; at < out.length; at++)
      out[at] = type === 0 ? view.getUint32(4 * at, true) : view.getFloat32(4 * at, true);
    return [out, end];
  }
  const block = new Uint16Array(SIDE * SIDE);
  let at = from;
  for (let top = 0; top < rows; top += SIDE) {
    for (let left = 0; left < width; left += SIDE) {
      if (at + FLAT > body.length) throw badFile("this EXR by B44 is cut off or damaged");
      at += unpack(body, at, block);
      for (let row = 0; row < SIDE && top + row < rows; row++)
        for (let column = 0; column < SIDE && left + column < width; column++)
          out[(top + row) * width + left + column] = half(block[SIDE * row + column] ?? 0);
    }
  }
  return [out, at];
}

/** What did not become shorter is stored as it is, line by line. */
function storedOf(body: Uint8Array, channels: Channel[], used: number, width: number, rows: number): Float32Array {
  const sizes = channels.map(({ type }) => width * (SIZES[type] ?? 0));
  const stride = sizes.reduce((sum, size) => sum + size, 0);
  const before = sizes.slice(0, used).reduce((sum, size) => sum + size, 0);
  const type = channels[used]?.type ?? 0;
  const view = new DataView(body.buffer, body.byteOffset, body.byteLength);
  return Float32Array.from({ length: width * rows }, (_, index) => {
    const at = Math.floor(index / width) * stride + before + (index % width) * (SIZES[type] ?? 0);
    return type === HALF
      ? half(view.getUint16(at, true))
      : type === 0
        ? view.getUint32(at, true)
        : view.getFloat32(at, true);
  });
}

export function readB44(bytes: Uint8Array, header: Header, used: number[]): Float32Array {
  const { width, height, lines, channels } = header;
  const data = new Float32Array(width * height * used.length).fill(NaN);
  for (const { row, body, length } of blocks(bytes, header)) {
    const rows = Math.min(lines, height - row);
    let from = 0;
    channels.forEach((channel, index) => {
      const to = used.indexOf(index);
      const isStored = body.length >= length;
      if (isStored && to < 0) return;
      const [values, next] = isStored
        ? [storedOf(body, channels, index, width, rows), 0]
        : channelOf(body, from, channel, width, rows);
      from = next;
      if (to >= 0) values.forEach((value, at) => (data[(row * width + at) * used.length + to] = value));
    });
  }
  return data;
}
