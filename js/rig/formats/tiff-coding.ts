/** Decompresses TIFF's codings; none writes more bytes than requested. */
import { badFile } from "../../errors.js";

const CLEAR = 256;
const END = 257;
const LONGEST_CODE = 12;

const short = (made: number, length: number) =>
  badFile(`this TIFF is damaged or cut off: one of its strips or tiles expands to ${made} of ${length} bytes`);

/** LZW with codes from the high bit down, whose width grows one code early. For each entry its predecessor and its last byte are kept. */
export function lzw(bytes: Uint8Array, length: number): Uint8Array {
  const out = new Uint8Array(length);
  /** The place in `out` where an entry was first written, and its length. */
  const places = new Uint32Array(1 << LONGEST_CODE);
  const lengths = new Uint32Array(1 << LONGEST_CODE);
  let [made, next, width, held, bits, last, lastAt] = [0, END + 1, 9, 0, 0, -1, 0];
  for (let at = 0; made < length; ) {
    while (bits < width && at < bytes.length) {
      held = ((held << 8) | (bytes[at++] ?? 0)) & 0xffffff;
      bits += 8;
    }
    if (bits < width) throw short(made, length);
    const code = (held >> (bits - width)) & ((1 << width) - 1);
    bits -= width;
    if (code === END) throw short(made, length);
    if (code === CLEAR) {
      [next, width, last] = [END + 1, 9, -1];
      continue;
    }
    const from = made;
    if (code < CLEAR) out[made++] = code;
    else if (code < next) made = copied(out, places[code] ?? 0, lengths[code] ?? 0, made);
    else if (code === next && last >= 0) made = copied(out, lastAt, from - lastAt, made, out[lastAt]);
    else throw badFile("this TIFF is damaged: its LZW data refer to a missing entry");
    // The previous entry and the first byte of this one are adjacent in `out`.
    if (last >= 0 && next < 1 << LONGEST_CODE) {
      places[next] = lastAt;
      lengths[next++] = from - lastAt + 1;
    }
    [last, lastAt] = [code, from];
    if (next + 1 >= 1 << width && width < LONGEST_CODE) width++;
  }
  return out;
}

/** Copies bytes within `out`, at most up to its end, and appends one byte if it is given. */
function copied(out: Uint8Array, from: number, count: number, made: number, more?: number): number {
  let at = made;
  for (let index = 0; index < count && at < out.length; index++) out[at++] = out[from + index] ?? 0;
  if (more !== undefined && at < out.length) out[at++] = more;
  return at;
}

export function packBits(bytes: Uint8Array, length: number): Uint8Array {
  const out = new Uint8Array(length);
  let made = 0;
  for (let at = 0; made < length; ) {
    const head = bytes[at++];
    if (head === undefined) throw short(made, length);
    if (head < 128) {
      for (let count = 0; count <= head && made < length; count++) {
        if (at >= bytes.length) throw short(made, length);
        out[made++] = bytes[at++] ?? 0;
      }
    } else if (head > 128) {
      const value = bytes[at++];
      if (value === undefined) throw short(made, length);
      for (let count = 0; count < 257 - head && made < length; count++) out[made++] = value;
    }
  }
  return out;
}

/** Each sample is the difference from the sample of the previous pixel. */
export function undoIntegers(part: Uint8Array, width: number, size: number, samples: number): void {
  const { buffer, byteOffset, length } = part;
  const values =
    size === 1
      ? part
      : size === 2
        ? new Uint16Array(buffer, byteOffset, length / 2)
        : new Uint32Array(buffer, byteOffset, Math.floor(length / 4));
  const stride = width * samples;
  for (let at = 0; at < values.length; at++)
    if (at % stride >= samples) values[at] = (values[at] ?? 0) + (values[at - samples] ?? 0);
}

/**
 * A row holds all high bytes, then all second bytes, and so on. Differences run over the whole row. The result is in little-endian order.
 */
export function undoFloats(part: Uint8Array, count: number, size: number, samples: number): void {
  const stride = count * size;
  const row = new Uint8Array(stride);
  for (let from = 0; from + stride <= part.length; from += stride) {
    row.set(part.subarray(from, from + stride));
    for (let at = samples; at < stride; at++) row[at] = (row[at] ?? 0) + (row[at - samples] ?? 0);
    for (let at = 0; at < count; at++)
      for (let byte = 0; byte < size; byte++) part[from + at * size + byte] = row[(size - 1 - byte) * count + at] ?? 0;
  }
}
