/** The netpbm family: PGM, PPM and PBM of 8 and 16 bits, as text or binary, and PFM's floats. */
import { badFile } from "../../errors.js";
import { checkBytes, checkSize } from "./limits.js";
import type { Picture } from "./picture.js";
import { Words } from "./tokens.js";

/** Largest maximum of PNM's samples; a larger one does not fit 16 bits. */
const MOST_LEVEL = 65_535;

const whole = (words: Words, what: string): number => {
  const word = words.next();
  if (!/^\d{1,9}$/.test(word))
    throw badFile(`its header has ${JSON.stringify(word.slice(0, 20))} where ${what} is needed`);
  return Number(word);
};

const FORMATS: Record<string, { format: string; channels: 1 | 3; isText: boolean; isBits?: true }> = {
  P1: { format: "PBM", channels: 1, isText: true, isBits: true },
  P2: { format: "PGM", channels: 1, isText: true },
  P3: { format: "PPM", channels: 3, isText: true },
  P4: { format: "PBM", channels: 1, isText: false, isBits: true },
  P5: { format: "PGM", channels: 1, isText: false },
  P6: { format: "PPM", channels: 3, isText: false },
};

/** Levels as stored, because depths must not be rescaled. Colours with an unusual maximum are scaled to the full range. */
export function readPnm(bytes: Uint8Array): Picture {
  const words = new Words(bytes, true);
  const name = words.next();
  const kind = Object.hasOwn(FORMATS, name) ? FORMATS[name] : undefined;
  if (kind === undefined) throw badFile(`it is netpbm's ${name}, which is not supported; P1 to P6 and PFM are`);
  const { format, channels, isText, isBits } = kind;
  const [width, height] = [whole(words, "a width"), whole(words, "a height")];
  checkSize(width, height);
  const most = isBits ? 1 : whole(words, "a maximum");
  if (most < 1 || most > MOST_LEVEL) throw badFile(`its maximum level is ${most}; it must be 1 to ${MOST_LEVEL}`);
  const count = width * height * channels;
  const data = most > 255 ? new Uint16Array(count) : new Uint8Array(count);
  if (isText && isBits) bitText(words, data);
  else if (isText) for (let at = 0; at < count; at++) data[at] = level(words, most, at, count);
  else if (isBits) unpackBits(bytes.subarray(words.at + 1), width, height, data);
  else unpackBytes(bytes.subarray(words.at + 1), data, most, `this ${format}`);
  if (isBits) data.forEach((bit, at) => (data[at] = bit === 0 ? 255 : 0));
  const full = most > 255 ? 65_535 : 255;
  if (channels === 3 && most !== full) data.forEach((value, at) => (data[at] = Math.round((value * full) / most)));
  return { width, height, channels, data, format, bits: isBits ? 1 : most > 255 ? 16 : 8, notes: [], warnings: [] };
}

function level(words: Words, most: number, at: number, count: number): number {
  const word = words.next();
  if (word === "") throw badFile(`it is cut off: ${at} of ${count} levels`);
  const value = Number(word);
  if (!Number.isInteger(value) || value < 0 || value > most)
    throw badFile(`its level ${at} is ${JSON.stringify(word.slice(0, 20))}; whole numbers up to ${most} are needed`);
  return value;
}

/** In P1 the spaces between bits may be missing. */
function bitText(words: Words, data: Uint8Array | Uint16Array): void {
  let word = "";
  for (let at = 0; at < data.length; at++) {
    if (word === "") word = words.next();
    const bit = word[0];
    if (bit !== "0" && bit !== "1")
      throw badFile(
        bit === undefined ? `it is cut off: ${at} of ${data.length} bits` : `its bit ${at} is ${JSON.stringify(bit)}`,
      );
    data[at] = Number(bit);
    word = word.slice(1);
  }
}

function unpackBits(body: Uint8Array, width: number, height: number, data: Uint8Array | Uint16Array): void {
  const stride = Math.ceil(width / 8);
  checkBytes(stride * height, body.length, "this PBM");
  for (let at = 0; at < data.length; at++) {
    const column = at % width;
    data[at] = ((body[Math.floor(at / width) * stride + (column >> 3)] ?? 0) >> (7 - (column & 7))) & 1;
  }
}

function unpackBytes(body: Uint8Array, data: Uint8Array | Uint16Array, most: number, what: string): void {
  const wide = data instanceof Uint16Array;
  checkBytes(wide ? 2 * data.length : data.length, body.length, what);
  for (let at = 0; at < data.length; at++) {
    const value = wide ? ((body[2 * at] ?? 0) << 8) | (body[2 * at + 1] ?? 0) : (body[at] ?? 0);
    data[at] = value;
    // Bytes in the wrong order exceed an unusual maximum; the depth reader handles them.
    if (value > most && !wide) throw badFile(`its level ${at} is ${value}, beyond its maximum of ${most}`);
  }
}

/** Rows are stored from the bottom up; the sign of the scale gives the byte order. */
export function readPfm(bytes: Uint8Array): Picture {
  const words = new Words(bytes, true);
  const channels = words.next() === "PF" ? 3 : 1;
  const [width, height] = [whole(words, "a width"), whole(words, "a height")];
  checkSize(width, height);
  const scale = Number(words.next() || NaN);
  if (!Number.isFinite(scale) || scale === 0)
    throw badFile("this PFM has no scale, whose sign gives the order of its bytes");
  const body = bytes.subarray(words.at + 1);
  const stride = width * channels;
  checkBytes(4 * stride * height, body.length, "this PFM");
  const view = new DataView(body.buffer, body.byteOffset, body.byteLength);
  const data = new Float32Array(stride * height);
  for (let row = 0; row < height; row++) {
    const from = (height - 1 - row) * stride;
    for (let at = 0; at < stride; at++) data[row * stride + at] = view.getFloat32(4 * (from + at), scale < 0);
  }
  return { width, height, channels, data, format: "PFM", bits: 32, notes: [], warnings: [] };
}
