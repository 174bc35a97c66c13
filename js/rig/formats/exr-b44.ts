/**
 * OpenEXR compressed with B44 or B44A, which parse-exr does not support. Halves are packed in tiles of 4x4 pixels: 14 bytes each, or 3
 * where all pixels are equal. Other types are not compressed. A block of lines has one channel after the other.
 */
import { badFile } from "../../errors.js";
import { half } from "../../half.js";
import { type Channel, type Header, SIZES, blocks } from "./exr-header.js";
import { HALF, channelOfLines, interleave, samplesOf } from "./exr-samples.js";

/** Pixels on a side of a tile, and its bytes in the long and in the short form. */
const [SIDE, LONG, FLAT] = [4, 14, 3];
/** The shift that marks a tile of equal pixels. */
const ALIKE = 13;

/** The six bits that begin at a bit. */
const six = (body: Uint8Array, at: number, bit: number): number => {
  const from = at + (bit >> 3);
  return ((((body[from] ?? 0) << 8) | (body[from + 1] ?? 0)) >> (10 - (bit & 7))) & 63;
};
/** The bits of a half from the stored integer, whose order is that of the numbers. */
const restored = (value: number): number => (value & 0x8000 ? value & 0x7fff : ~value & 0xffff);

/** Unpacks the bits of a tile's sixteen halves, row by row, and returns its number of bytes. */
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
  // The first column is stored downwards, then each further column as differences from the one before.
  let bit = 22;
  for (let row = 1; row < SIDE; row++, bit += 6) raw[SIDE * row] = (raw[SIDE * (row - 1)] ?? 0) + step(bit);
  for (let column = 1; column < SIDE; column++)
    for (let row = 0; row < SIDE; row++, bit += 6)
      raw[SIDE * row + column] = (raw[SIDE * row + column - 1] ?? 0) + step(bit);
  raw.forEach((value, index) => (out[index] = restored(value & 0xffff)));
  return LONG;
}

/** One channel of a block of lines, and where the next one begins. */
function channelOf(
  body: Uint8Array,
  from: number,
  { type }: Channel,
  width: number,
  rows: number,
): [Float32Array, number] {
  if (type !== HALF) {
    const end = from + width * rows * (SIZES[type] ?? 0);
    if (end > body.length) throw badFile("this EXR (B44) is cut off or damaged");
    return [samplesOf(body.subarray(from, end), type), end];
  }
  const out = new Float32Array(width * rows);
  const block = new Uint16Array(SIDE * SIDE);
  let at = from;
  for (let top = 0; top < rows; top += SIDE) {
    for (let left = 0; left < width; left += SIDE) {
      if (at + FLAT > body.length) throw badFile("this EXR (B44) is cut off or damaged");
      at += unpack(body, at, block);
      for (let row = 0; row < SIDE && top + row < rows; row++)
        for (let column = 0; column < SIDE && left + column < width; column++)
          out[(top + row) * width + left + column] = half(block[SIDE * row + column] ?? 0);
    }
  }
  return [out, at];
}

export function readB44(bytes: Uint8Array, header: Header, used: number[]): Float32Array {
  const { width, height, lines, channels } = header;
  const data = new Float32Array(width * height * used.length).fill(NaN);
  for (const { row, body, length } of blocks(bytes, header)) {
    const rows = Math.min(lines, height - row);
    let from = 0;
    channels.forEach((channel, index) => {
      const to = used.indexOf(index);
      // A block that compression would not shorten is stored as it is.
      const isStored = body.length >= length;
      if (isStored && to < 0) return;
      const [values, next] = isStored
        ? [channelOfLines(body, header, index, rows), 0]
        : channelOf(body, from, channel, width, rows);
      from = next;
      if (to >= 0) interleave(values, data, row * width, used.length, to);
    });
  }
  return data;
}
