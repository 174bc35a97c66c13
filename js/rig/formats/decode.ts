/** Decodes the text of a file. text.ts, which is loaded with the first text, reads its content. */
import { MOST_TEXT } from "./limits.js";

/** The text of a file; undefined where its bytes are not text. */
export function textOf(bytes: Uint8Array): string | undefined {
  if (bytes.length > MOST_TEXT) return undefined;
  const [first, second] = bytes;
  const encoding =
    first === 0xff && second === 0xfe ? "utf-16le" : first === 0xfe && second === 0xff ? "utf-16be" : "utf-8";
  const text = decoded(bytes, encoding) ?? (isMostlyAscii(bytes) ? decoded(bytes, "windows-1252") : undefined);
  // Binary files contain control characters.
  return text === undefined || /[\0-\x08\x0e-\x1f]/.test(text) ? undefined : text;
}

function decoded(bytes: Uint8Array, encoding: string): string | undefined {
  try {
    return new TextDecoder(encoding, { fatal: true }).decode(bytes);
  } catch {
    return undefined;
  }
}

/** Editors of an older Windows keep umlauts and degree signs in one byte; numbers and names of members are ASCII in any of its code pages. */
const MOSTLY = 0.8;
const isMostlyAscii = (bytes: Uint8Array): boolean =>
  bytes.reduce((count, byte) => count + (byte < 128 ? 1 : 0), 0) > MOSTLY * bytes.length;
