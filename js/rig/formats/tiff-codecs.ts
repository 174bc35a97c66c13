/**
 * Strips and tiles of TIFF that are compressed by ZSTD or LERC, read by fzstd and lerc. Loaded with the first such file.
 *
 * Neither decoder writes more than requested: fzstd gets a buffer of fixed size, and the declared sizes of a LERC blob are checked first.
 */
import { decompress } from "fzstd";
import Lerc from "lerc";
import { badFile } from "../../errors.js";
import { inflateUpTo } from "../../inflate.js";
import { OVERHEAD } from "./limits.js";

/** An array of `length` bytes, filled as far as there are data. */
export const unpackZstd = (bytes: Uint8Array, length: number): Uint8Array => decompress(bytes, new Uint8Array(length));

/** The second compression that LERC data may have. */
const [DEFLATE, ZSTD] = [1, 2];
/** Bytes of a value of each of LERC's types. */
const SIZES = [1, 1, 2, 2, 4, 4, 4, 8];

/** A blob of this many bytes, in this machine's order; lerc would loop forever on blobs of no length or blocks of no pixels. */
export function unpackLerc(packed: Uint8Array, length: number, again: number): Uint8Array {
  const most = 2 * length + OVERHEAD;
  const bytes =
    again === DEFLATE ? inflateUpTo(packed, most, "this TIFF") : again === ZSTD ? unpackZstd(packed, most) : packed;
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  const isKnown = String.fromCharCode(...bytes.subarray(0, 6)) === "Lerc2 ";
  const version = isKnown ? view.getInt32(6, true) : 0;
  // Since version 3, a checksum follows name and version.
  const at = version >= 3 ? 14 : 10;
  const word = (index: number) => view.getUint32(at + 4 * index, true);
  const [height, width, depths] = [word(0), word(1), version >= 4 ? word(2) : 1];
  // The size of a block follows the number of valid pixels.
  const [block, declared, type] = (version >= 4 ? [4, 5, 6] : [3, 4, 5]).map(word) as [number, number, number];
  const isSound = isKnown && block >= 1 && declared <= bytes.length;
  if (!isSound || width * height * depths * (SIZES[type] ?? 0) !== length)
    throw badFile("this TIFF is damaged, or compressed with an unsupported kind of LERC");
  const [values] = Lerc.decode(bytes.slice(0, declared).buffer, { returnPixelInterleavedDims: true }).pixels;
  if (values?.byteLength !== length)
    throw badFile("this TIFF is damaged: one of its strips or tiles (LERC) is incomplete");
  return new Uint8Array(values.buffer, values.byteOffset, length);
}
