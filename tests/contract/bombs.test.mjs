// Small files that declare, or inflate to, more than any machine's memory are refused before the memory is allocated.
import assert from "node:assert/strict";
import { test } from "node:test";
import { crc32, deflateSync } from "node:zlib";
import { BimodalError, decodeColour, decodeDepth } from "../../pkg/files.js";
import { readRigFile } from "../../pkg/rig.js";
import { png } from "./support.mjs";

const MEGABYTE = 2 ** 20;
/** Limit of a reader's memory in addition to the file, for a picture of few pixels. */
const ROOM = 200 * MEGABYTE;
/** 100 MB of zeros in 100 kB. */
const bomb = deflateSync(Buffer.alloc(100 * MEGABYTE));

function chunk(type, data) {
  const body = Buffer.concat([Buffer.from(type, "latin1"), data]);
  const [length, sum] = [Buffer.alloc(4), Buffer.alloc(4)];
  length.writeUInt32BE(data.length);
  sum.writeUInt32BE(crc32(body));
  return Buffer.concat([length, body, sum]);
}

function pngOf(width, height, { bits = 8, type = 0, pixels = bomb, before = [] } = {}) {
  const header = Buffer.alloc(13);
  header.writeUInt32BE(width, 0);
  header.writeUInt32BE(height, 4);
  header.set([bits, type], 8);
  return new Uint8Array(
    Buffer.concat([
      Buffer.from("\x89PNG\r\n\x1a\n", "latin1"),
      chunk("IHDR", header),
      ...before,
      chunk("IDAT", pixels),
      chunk("IEND", Buffer.alloc(0)),
    ]),
  );
}

/** A little-endian TIFF with one strip, compressed by deflate. */
function tiffOf(width, height) {
  const tags = [
    [256, width],
    [257, height],
    [258, 16],
    [259, 8],
    [262, 1],
    [273, 0],
    [277, 1],
    [278, height],
    [279, bomb.length],
  ];
  const head = Buffer.alloc(14 + 12 * tags.length);
  head.write("II*\0", "latin1");
  head.writeUInt32LE(8, 4);
  head.writeUInt16LE(tags.length, 8);
  tags.forEach(([tag, value], index) => {
    const at = 10 + 12 * index;
    head.writeUInt16LE(tag, at);
    head.writeUInt16LE(4, at + 2);
    head.writeUInt32LE(1, at + 4);
    head.writeUInt32LE(tag === 273 ? head.length : value, at + 8);
  });
  return new Uint8Array(Buffer.concat([head, bomb]));
}

/** An OpenEXR image with one channel and one ZIP block. */
function exrOf(width, height) {
  const attribute = (name, type, data) => {
    const size = Buffer.alloc(4);
    size.writeInt32LE(data.length);
    return Buffer.concat([Buffer.from(`${name}\0${type}\0`, "latin1"), size, data]);
  };
  const ints = (...values) => Buffer.from(Int32Array.from(values).buffer);
  const floats = (...values) => Buffer.from(Float32Array.from(values).buffer);
  const box = ints(0, 0, width - 1, height - 1);
  const head = Buffer.concat([
    ints(20000630, 2),
    attribute("channels", "chlist", Buffer.concat([Buffer.from("Z\0", "latin1"), ints(2, 0, 1, 1), Buffer.from([0])])),
    attribute("compression", "compression", Buffer.from([3])),
    attribute("dataWindow", "box2i", box),
    attribute("displayWindow", "box2i", box),
    attribute("lineOrder", "lineOrder", Buffer.from([0])),
    attribute("pixelAspectRatio", "float", floats(1)),
    attribute("screenWindowCenter", "v2f", floats(0, 0)),
    attribute("screenWindowWidth", "float", floats(1)),
    Buffer.from([0]),
  ]);
  const offset = Buffer.alloc(8);
  offset.writeUInt32LE(head.length + 8);
  return new Uint8Array(Buffer.concat([head, offset, ints(0, bomb.length), bomb]));
}

/** Checks that a file is refused for this reason, without memory for its contents. */
async function refusedSmall(read, reason) {
  const before = process.memoryUsage().arrayBuffers;
  let most = 0;
  const Plain = Uint8Array;
  globalThis.Uint8Array = new Proxy(Plain, {
    construct(target, given, own) {
      if (typeof given[0] === "number") most = Math.max(most, given[0]);
      return Reflect.construct(target, given, own);
    },
  });
  try {
    await assert.rejects(
      async () => read(),
      (error) => error instanceof BimodalError && error.code === "file" && reason.test(error.message),
      String(reason),
    );
  } finally {
    globalThis.Uint8Array = Plain;
  }
  assert.ok(most < ROOM, `${most} bytes at once`);
  assert.ok(process.memoryUsage().arrayBuffers - before < ROOM);
}

const rig = (name, bytes) => () => readRigFile({ name, bytes });

for (const [name, decode] of [
  ["colour", decodeColour],
  ["depth", decodeDepth],
]) {
  test(`the Lab's reader of ${name}: a PNG that inflates to more than it declares, one that declares too much, one without end`, async () => {
    await refusedSmall(() => decode(pngOf(8, 8)), /longer than the raw|inflates to more/);
    await refusedSmall(() => decode(pngOf(2 ** 31 - 1, 2 ** 31 - 1)), /up to 134217728 pixels are supported/);
    await refusedSmall(() => decode(pngOf(100_000, 2000, { bits: 1 })), /up to 134217728 pixels are supported/);
    await refusedSmall(() => decode(pngOf(11_000, 11_000, { bits: 16, type: 6 })), /cannot inflate to/);
  });
}

test("an ICC profile, and texts, that inflate without end are passed over", async () => {
  const packed = (type, head) => chunk(type, Buffer.concat([Buffer.from(head, "latin1"), bomb]));
  const pixels = deflateSync(Buffer.concat(Array.from({ length: 4 }, () => Buffer.from([0, 10, 60, 200, 250]))));
  const before = [packed("iCCP", "p\0\0"), packed("zTXt", "Title\0\0"), packed("iTXt", "Title\0\x01\0\0\0")];
  const small = pngOf(4, 4, { pixels, before });
  assert.equal(decodeColour(small).width, 4);
  const { image } = await readRigFile({ name: "rgb.png", bytes: small }, { as: "colour" });
  assert.equal(image.width, 4);
  assert.ok(process.memoryUsage().arrayBuffers < ROOM);
});

test("the rig's readers: PNG, TIFF, OpenEXR", async () => {
  await refusedSmall(rig("a.png", pngOf(8, 8)), /longer than the raw|inflates to more/);
  await refusedSmall(rig("b.png", pngOf(70_000, 70_000)), /up to 4096 on a side/);
  await refusedSmall(rig("a.tif", tiffOf(8, 8)), /damaged|inflates to more/);
  await refusedSmall(rig("a.exr", exrOf(8, 8)), /damaged|inflates to more/);
});

test("what is within the limits is read", () => {
  const rows = Array.from({ length: 4 }, () => [10, 20, 30, 40]);
  assert.equal(decodeColour(png({ width: 4, height: 4, depth: 8, colourType: 0, rows })).height, 4);
});
