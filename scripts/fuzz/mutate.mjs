// Mutates files: bytes, numbers, words and pieces. A PNG gets valid checksums again, so that the code behind the checks is reached.
import { crc32, deflateSync, inflateSync } from "node:zlib";

/** Longest generated file, bytes. */
const LONGEST = 16_384;
const BYTES = [0, 1, 255, 127, 128, 45, 46, 48, 57, 10, 32, 34, 44, 58];
const NUMBERS = [0, 1, -1, 2 ** 15, 2 ** 16 - 1, 2 ** 31 - 1, -(2 ** 31), 4096, 4097, 100, 1000];
/** Words with a special meaning in formats of text. */
const WORDS = [
  "nan",
  "inf",
  "-1",
  "0",
  "1e999",
  "1e-320",
  "4294967296",
  "65536",
  ".5",
  "0x10",
  "true",
  "null",
  "{",
  "}",
  "[",
  "]",
  ": ",
  "- ",
  "&a ",
  "*a",
  "<",
  ">",
  "</",
  "<!--",
  "&lt;",
  "&#x110000;",
  "\n",
  "\r\n",
  "\t",
  "  ",
  "#",
  "---\n",
  "%YAML:1.0\n",
  "!!opencv-matrix",
  "|\n",
  ">\n",
  "'",
  '"',
  "\\",
  "\\u0000",
  "camera_matrix",
  "distortion_coefficients",
  "rows: 3",
  "data",
  "R",
  "T_cam_imu",
  "T_cn_cnm1",
  "rotation",
  "translation",
  "quaternion",
  "PINHOLE",
  "OPENCV_FISHEYE",
  "equidistant",
  "radtan",
  "binary_compressed",
  "ascii",
  "binary_little_endian",
  "property list uchar int ",
  "property double x\n",
  "element vertex ",
  "end_header\n",
  "COUNT 2 2 2\n",
  "SIZE 8 8 8\n",
  "TYPE I U F\n",
  "P1\n",
  "P4\n",
  "P7\n",
  "Pf\n",
  "-1.0\n",
];

const joined = (...parts) => new Uint8Array(Buffer.concat(parts));
const text = (words) => new TextEncoder().encode(words);

/** A random position, more often in the head of a file than behind it. */
const place = (random, length) => random.below(random.chance(0.6) ? Math.min(length, 160) : length);

const STEPS = [
  (file, random) => {
    const at = place(random, file.length);
    file[at] ^= 1 << random.below(8);
    return file;
  },
  (file, random) => {
    file[place(random, file.length)] = random.chance(0.5) ? random.pick(BYTES) : random.below(256);
    return file;
  },
  (file, random) => {
    const view = new DataView(file.buffer, file.byteOffset, file.length);
    const width = random.pick([2, 4]);
    if (file.length < width) return file;
    const at = Math.min(place(random, file.length), file.length - width);
    const little = random.chance(0.5);
    const before = width === 2 ? view.getUint16(at, little) : view.getUint32(at, little);
    const value = random.chance(0.5) ? random.pick(NUMBERS) : before + random.below(35) - 17;
    if (width === 2) view.setUint16(at, value, little);
    else view.setUint32(at, value, little);
    return file;
  },
  (file, random) => {
    const at = place(random, file.length);
    return joined(
      file.subarray(0, at),
      text(random.pick(WORDS)),
      file.subarray(at + (random.chance(0.5) ? 0 : random.below(12))),
    );
  },
  (file, random) => file.slice(0, random.below(file.length) + 1),
  (file, random) => {
    const [a, b] = [random.below(file.length), random.below(file.length)].sort((x, y) => x - y);
    return random.chance(0.5)
      ? joined(file.subarray(0, a), file.subarray(b))
      : joined(file.subarray(0, b), file.subarray(a));
  },
  (file, random, others) => {
    const other = random.pick(others);
    const from = random.below(other.length);
    const piece = other.subarray(from, from + 1 + random.below(64));
    const at = place(random, file.length);
    return joined(file.subarray(0, at), piece, file.subarray(random.chance(0.5) ? at : at + piece.length));
  },
  numberChanged,
];

/** Replaces a number of a text. */
function numberChanged(file, random) {
  const words = Buffer.from(file).toString("latin1");
  const found = [...words.matchAll(/-?\d+(?:\.\d*)?(?:e[+-]?\d+)?/gi)];
  if (found.length === 0) return file;
  const { 0: old, index } = random.pick(found);
  const value = random.pick([
    "0",
    "-1",
    "1",
    "2",
    "3",
    "4",
    "7",
    "16",
    "4097",
    "1e999",
    "nan",
    "",
    `-${old}`,
    `${old}0`,
    String(Number(old) + 1),
    String(1 / (Number(old) || 1)),
  ]);
  return joined(file.subarray(0, index), text(value), file.subarray(index + old.length));
}

/** A copy of a file after a few mutations. */
export function mutated(file, others, random) {
  if (random.chance(0.7)) {
    const png = pngMutated(file, others, random);
    if (png) return png;
  }
  return steps(file, others, random);
}

function steps(file, others, random) {
  let made = file.slice();
  for (let count = 1 + random.below(random.chance(0.2) ? 12 : 4); count > 0; count--) {
    if (made.length === 0) made = random.pick(others).slice();
    made = random.pick(STEPS)(made, random, others);
  }
  return made.slice(0, LONGEST);
}

const SIGNATURE = Buffer.from("\x89PNG\r\n\x1a\n", "latin1");

/** A PNG with one chunk changed and its structure intact; undefined if the file is not a PNG. */
function pngMutated(file, others, random) {
  const parts = pngParts(Buffer.from(file.buffer, file.byteOffset, file.length));
  if (parts === undefined || parts.length === 0) return undefined;
  const chosen = random.pick(parts);
  if (chosen.type === "IDAT" && random.chance(0.7)) {
    try {
      chosen.body = deflateSync(
        steps(new Uint8Array(inflateSync(chosen.body, { maxOutputLength: LONGEST })), others, random),
      );
    } catch {
      // The data may be damaged already, or split over several chunks.
      chosen.body = Buffer.from(steps(chosen.body, others, random));
    }
  } else if (chosen.body.length > 0) chosen.body = Buffer.from(steps(new Uint8Array(chosen.body), others, random));
  if (random.chance(0.1)) parts.splice(random.below(parts.length), 1);
  return joined(SIGNATURE, ...parts.map(framed));
}

function pngParts(file) {
  if (!file.subarray(0, 8).equals(SIGNATURE)) return undefined;
  const parts = [];
  for (let at = 8; at + 12 <= file.length; ) {
    const length = file.readUInt32BE(at);
    if (at + 12 + length > file.length) return undefined;
    parts.push({ type: file.toString("latin1", at + 4, at + 8), body: file.subarray(at + 8, at + 8 + length) });
    at += 12 + length;
  }
  return parts;
}

function framed({ type, body }) {
  const frame = Buffer.alloc(body.length + 12);
  frame.writeUInt32BE(body.length, 0);
  frame.write(type, 4, "latin1");
  frame.set(body, 8);
  frame.writeUInt32BE(crc32(frame.subarray(4, 8 + body.length)), 8 + body.length);
  return frame;
}
