// Files of a rig that are malformed on purpose, made byte by byte, and limits of the time and memory for reading one.
import assert from "node:assert/strict";
import { crc32, deflateSync } from "node:zlib";
import { fixture, text } from "./rig-support.mjs";

export const MEGABYTE = 2 ** 20;
/** Limits for reading a file, milliseconds and bytes. */
const MOST_MILLISECONDS = 1000;
const MOST_MEMORY = 2 ** 30;

/**
 * Runs code that may be slow and checks its processor time, since other programs may delay the clock. The best of three trials counts, since
 * they also compete for the caches.
 */
export async function inTime(what, run) {
  let spent = Infinity;
  for (let attempt = 0; attempt < 3 && spent > MOST_MILLISECONDS; attempt++) {
    const before = process.cpuUsage();
    await run();
    const { user, system } = process.cpuUsage(before);
    spent = (user + system) / 1000;
  }
  assert.ok(spent <= MOST_MILLISECONDS, `${what}: ${spent} ms`);
}

const BUFFERS = [
  ...["ArrayBuffer", "Uint8Array", "Uint8ClampedArray", "Int8Array", "Uint16Array", "Int16Array", "Uint32Array"],
  ...["Int32Array", "Float32Array", "Float64Array", "BigInt64Array", "BigUint64Array"],
];

/**
 * Runs code that may allocate and checks the sum of all requested buffers: memory that is never written to is not resident and would not
 * count in the memory of this process.
 */
export async function inRoom(what, run) {
  let asked = 0;
  const plain = BUFFERS.map((name) => [name, globalThis[name]]);
  for (const [name, Buffer] of plain) {
    globalThis[name] = new Proxy(Buffer, {
      construct(target, given, own) {
        const [first] = given;
        const each = target.BYTES_PER_ELEMENT ?? 1;
        if (!(first instanceof ArrayBuffer)) asked += each * (typeof first === "number" ? first : (first?.length ?? 0));
        return Reflect.construct(target, given, own);
      },
    });
    // Copies, slices and maps use the prototype's constructor.
    Buffer.prototype.constructor = globalThis[name];
  }
  try {
    await run();
  } finally {
    for (const [name, Buffer] of plain) {
      globalThis[name] = Buffer;
      Buffer.prototype.constructor = Buffer;
    }
  }
  assert.ok(asked < MOST_MEMORY, `${what}: ${(asked / MEGABYTE).toFixed(0)} MB`);
}

/** Asserts that this process has never used a gigabyte. */
export function assertSmall() {
  const most = 1024 * process.resourceUsage().maxRSS;
  assert.ok(most < MOST_MEMORY, `${(most / MEGABYTE).toFixed(0)} MB`);
}

export const bytes = (...parts) => new Uint8Array(Buffer.concat(parts.map((part) => Buffer.from(part))));
export const u32 = (...values) =>
  bytes(...values.map((value) => new Uint8Array([value, value >> 8, value >> 16, value >> 24])));
export const cut = (name, length) => fixture(name).slice(0, length);
export const changed = (name, ...changes) => {
  const file = fixture(name);
  for (const [at, value] of changes) file[at < 0 ? file.length + at : at] = value;
  return file;
};

/** A chunk of a PNG with its checksum. */
export const chunk = (type, data) => {
  const body = Buffer.concat([Buffer.from(type, "latin1"), data]);
  const frame = Buffer.alloc(8);
  frame.writeUInt32BE(data.length, 0);
  frame.writeUInt32BE(crc32(body), 4);
  return Buffer.concat([frame.subarray(0, 4), body, frame.subarray(4)]);
};
export const ihdr = (width, height, depth = 8, type = 2, interlace = 0) => {
  const data = Buffer.alloc(13);
  data.writeUInt32BE(width, 0);
  data.writeUInt32BE(height, 4);
  data.set([depth, type, 0, 0, interlace], 8);
  return chunk("IHDR", data);
};
export const pngOf = (...chunks) =>
  bytes(
    "\x89PNG\r\n\x1a\n".split("").map((letter) => letter.charCodeAt(0)),
    ...chunks,
    chunk("IEND", Buffer.alloc(0)),
  );
export const idat = (length) => chunk("IDAT", deflateSync(Buffer.alloc(length)));

/** A TIFF with one strip; tags are [tag, value] with one 32-bit number each. */
export const tiff = (tags, body = new Uint8Array(0)) => {
  const view = new DataView(new ArrayBuffer(14 + 12 * tags.length));
  view.setUint32(0, 0x002a4949, true);
  view.setUint32(4, 8, true);
  view.setUint16(8, tags.length, true);
  tags.forEach(([tag, value], at) => {
    view.setUint16(10 + 12 * at, tag, true);
    view.setUint16(12 + 12 * at, 4, true);
    view.setUint32(14 + 12 * at, 1, true);
    view.setUint32(18 + 12 * at, value, true);
  });
  return bytes(new Uint8Array(view.buffer), body);
};
export const tiffTags = (width, height, more = {}) =>
  Object.entries({
    256: width,
    257: height,
    258: 16,
    259: 1,
    273: 200,
    277: 1,
    278: height,
    279: 2 * width * height,
    ...more,
  }).map(([tag, value]) => [Number(tag), value]);

/** A JPEG that consists only of markers. */
export const jpeg = (
  width,
  height,
  { channels = 3, bits = 8, kind = 0xc0, sampling = 0x11, scans = 1, tail = [] } = {},
) =>
  bytes(
    [0xff, 0xd8],
    [0xff, kind, 0, 8 + 3 * channels, bits, height >> 8, height & 255, width >> 8, width & 255, channels],
    Array.from({ length: channels }, (_, at) => [at + 1, sampling, 0]).flat(),
    ...Array.from({ length: scans }, () => [0xff, 0xda, 0, 8, 1, 1, 0, 0, 63, 0]),
    tail,
    [0xff, 0xd9],
  );

export const pcd = (changes, body = "") => {
  const lines = {
    VERSION: "0.7",
    FIELDS: "x y z",
    SIZE: "4 4 4",
    TYPE: "F F F",
    COUNT: "1 1 1",
    WIDTH: "2",
    HEIGHT: "2",
    VIEWPOINT: "0 0 0 1 0 0 0",
    POINTS: "4",
    DATA: "ascii",
    ...changes,
  };
  return bytes(
    text(
      Object.entries(lines)
        .map(([key, value]) => `${key} ${value}\n`)
        .join(""),
    ),
    body,
  );
};
export const ply = (count, body, more = "", format = "ascii") =>
  bytes(
    text(
      `ply\nformat ${format} 1.0\n${more}element vertex ${count}\nproperty float x\nproperty float y\nproperty float z\nend_header\n`,
    ),
    body,
  );
export const laughs = "abcdefghij"
  .split("")
  .map(
    (key, at) =>
      `${key}: &${key} [${Array(9)
        .fill(at === 0 ? "1" : `*${"abcdefghij"[at - 1]}`)
        .join(", ")}]`,
  )
  .join("\n");
export const exr = (changes, name = "depth-zip.exr") => {
  const file = fixture(name);
  const at = (name) => Buffer.from(file).indexOf(name) + name.length;
  changes(file, new DataView(file.buffer), at);
  return file;
};

/** Offset of the table of an EXR with several blocks. Its first entry is found as a number that points behind the table. */
function blocksAt(view) {
  for (let at = 0; at + 8 < view.byteLength; at++) {
    const first = view.getUint32(at, true);
    if (first > at && first < at + 200 && (first - at) % 8 === 0 && view.getUint32(at + 4, true) === 0) return at;
  }
  throw new Error("no table");
}

/** The second entry of the table gets the offset of the first block. */
export const twice = (_, view) => view.setUint32(blocksAt(view) + 8, view.getUint32(blocksAt(view), true), true);

/** Offset of the table of an EXR with one block, which directly follows the table. */
export function table(view) {
  for (let at = 0; at + 8 < view.byteLength; at++)
    if (view.getUint32(at, true) === at + 8 && view.getUint32(at + 4, true) === 0) return at;
  throw new Error("no table");
}

/** The same file with another compression in its header. */
export const packed = (name, compression) => {
  const file = fixture(name);
  const at = Buffer.from(file).indexOf("compression\0compression\0") + "compression\0compression\0".length;
  file[at + 4] = compression;
  return file;
};

/** An EXR whose first block inflates to two megabytes. */
export function bombOf(name) {
  const file = fixture(name);
  const view = new DataView(file.buffer);
  const from = Number(view.getBigUint64(blocksAt(view), true));
  const bomb = deflateSync(Buffer.alloc(2 * MEGABYTE));
  return bytes(file.subarray(0, from + 4), u32(bomb.length), bomb, new Uint8Array(30_000));
}

/** A ZSTD frame that declares this many bytes and holds none. */
export const zstdOf = (declared) => bytes([0x28, 0xb5, 0x2f, 0xfd, 0xa0], u32(declared), [1, 0, 0]);

/** The header of a LERC blob, second version. */
export const lercOf = ({ width = 4, height = 4, block = 8, length = 100 }) =>
  bytes(text("Lerc2 "), u32(2, height, width, width * height, block, length, 3), new Uint8Array(100)).slice(0, 100);
