/**
 * LZ4 frames, which compress the chunks of MCAP files and ROS bags: literals and copies of earlier bytes. Checksums are skipped.
 *
 * The packages on npm have no licence, or a .wasm that only one bundler can include.
 */
import { badFile } from "../../errors.js";

const MAGIC = 0x184d2204;
/** Flags of a frame: dictionary, checksum of the content, its size, checksums of the blocks. */
const [DICTIONARY, CONTENT_CHECKSUM, CONTENT_SIZE, BLOCK_CHECKSUM] = [1, 4, 8, 16];
const STORED = 0x80000000;

const damaged = () => badFile("one of its chunks is damaged (LZ4)");

/** A length that continues while its bytes are 255. */
function longer(bytes: Uint8Array, at: number, length: number): [length: number, at: number] {
  if (length !== 15) return [length, at];
  let byte = 255;
  let total = length;
  while (byte === 255) {
    if (at >= bytes.length) throw damaged();
    byte = bytes[at++] ?? 0;
    total += byte;
  }
  return [total, at];
}

/** Appends one block to the output and returns where it ends. */
function block(from: Uint8Array, out: Uint8Array, start: number): number {
  let [at, to] = [0, start];
  while (at < from.length) {
    const token = from[at++] ?? 0;
    let literals: number;
    [literals, at] = longer(from, at, token >> 4);
    if (at + literals > from.length || to + literals > out.length) throw damaged();
    out.set(from.subarray(at, at + literals), to);
    [at, to] = [at + literals, to + literals];
    if (at === from.length) return to;
    const offset = (from[at] ?? 0) | ((from[at + 1] ?? 0) << 8);
    let copied: number;
    [copied, at] = longer(from, at + 2, token & 15);
    copied += 4;
    if (offset === 0 || offset > to || to + copied > out.length) throw damaged();
    if (offset >= copied) out.copyWithin(to, to - offset, to - offset + copied);
    // The copy overlaps itself: it repeats the bytes that it writes.
    else for (let i = 0; i < copied; i++) out[to + i] = out[to + i - offset] ?? 0;
    to += copied;
  }
  return to;
}

/** Decompresses a frame of known size. */
export function lz4(bytes: Uint8Array, size: number): Uint8Array {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  if (bytes.length < 7 || view.getUint32(0, true) !== MAGIC) throw damaged();
  const flags = bytes[4] ?? 0;
  if (flags & DICTIONARY)
    throw badFile("one of its chunks is compressed with an LZ4 dictionary, which is not supported");
  const out = new Uint8Array(size);
  let at = 7 + (flags & CONTENT_SIZE ? 8 : 0);
  let to = 0;
  for (;;) {
    if (at + 4 > bytes.length) throw damaged();
    const head = view.getUint32(at, true);
    at += 4;
    if (head === 0) break;
    const length = head & ~STORED;
    const body = bytes.subarray(at, at + length);
    if (body.length < length) throw damaged();
    if (head & STORED) {
      if (to + length > size) throw damaged();
      out.set(body, to);
      to += length;
    } else to = block(body, out, to);
    at += length + (flags & BLOCK_CHECKSUM ? 4 : 0);
  }
  if (to !== size || (flags & CONTENT_CHECKSUM && at + 4 > bytes.length)) throw damaged();
  return out;
}
