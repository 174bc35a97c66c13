/** Inflates zlib data up to the expected length, so that the length that the file declares bounds memory and time. */
import { Inflate, Unzlib } from "fflate";
import { badFile } from "./errors.js";

/** Bytes given to the decoder at a time. */
const PIECE = 16_384;
/** Largest number of bytes that deflate makes of one byte. */
const MOST_OF_ONE = 1032;

class TooLong extends Error {}

/** Inflates `bytes` to at most `most` bytes, or returns the reason for a failure; `Stream` handles the header. */
export function inflateUpTo(
  bytes: Uint8Array,
  most: number,
  what: string,
  Stream: typeof Unzlib | typeof Inflate = Unzlib,
): Uint8Array {
  const out = new Uint8Array(most);
  let length = 0;
  const stream = new Stream((piece) => {
    if (length + piece.length > most) throw new TooLong();
    out.set(piece, length);
    length += piece.length;
  });
  try {
    for (let at = 0; at < bytes.length; at += PIECE)
      stream.push(bytes.subarray(at, at + PIECE), at + PIECE >= bytes.length);
  } catch (error) {
    if (error instanceof TooLong)
      throw badFile(`${what} is damaged: it inflates to more than the ${most} bytes that it declares`);
    throw badFile(`${what} is damaged or cut off (${error instanceof Error ? error.message : String(error)})`, error);
  }
  return out.subarray(0, length);
}

/** Inflates zlib data that must have exactly this length. */
function exactly(bytes: Uint8Array, length: number, what: string, Stream: typeof Unzlib | typeof Inflate): Uint8Array {
  if (length > MOST_OF_ONE * bytes.length)
    throw badFile(`${what} is cut off: ${bytes.length} bytes cannot inflate to the ${length} that it declares`);
  const out = inflateUpTo(bytes, length, what, Stream);
  if (out.length < length) throw badFile(`${what} is cut off: it inflates to ${out.length} of ${length} bytes`);
  return out;
}

export const inflateExactly = (bytes: Uint8Array, length: number, what: string): Uint8Array =>
  exactly(bytes, length, what, Unzlib);

/** Inflates deflate data without zlib's header, as ZIP archives store them. */
export const inflateRaw = (bytes: Uint8Array, length: number, what: string): Uint8Array =>
  exactly(bytes, length, what, Inflate);
