// Compares the PNG decoder with an independent one, fast-png, on random bytes under every filter.
import assert from "node:assert/strict";
import { test } from "node:test";
import { crc32, deflateSync } from "node:zlib";
import { convertIndexedToRgb, decode } from "fast-png";
import { decodeColour } from "../../pkg/files.js";
import { readRigFile } from "../../pkg/rig.js";

const SIGNATURE = [0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a];
const ADAM7 = [
  [0, 0, 8, 8],
  [4, 0, 8, 8],
  [0, 4, 4, 8],
  [2, 0, 4, 4],
  [0, 2, 2, 4],
  [1, 0, 2, 2],
  [0, 1, 1, 2],
];
const CHANNELS = { 0: 1, 2: 3, 3: 1, 4: 2, 6: 4 };

/** Numerical Recipes' quick generator. */
function random(seed) {
  let state = seed;
  return (below) => {
    state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
    return Math.floor((state / 2 ** 32) * below);
  };
}

function chunk(type, body) {
  const bytes = Buffer.concat([Buffer.alloc(4), Buffer.from(type), Buffer.from(body), Buffer.alloc(4)]);
  bytes.writeUInt32BE(body.length, 0);
  bytes.writeUInt32BE(crc32(bytes.subarray(4, -4)), bytes.length - 4);
  return bytes;
}

/** Random bytes serve as filtered rows, since any bytes are the rows of some image. */
function randomPng({ width, height, bits, type, interlaced, draw, palette, alpha }) {
  const header = Buffer.alloc(13);
  header.writeUInt32BE(width, 0);
  header.writeUInt32BE(height, 4);
  header.set([bits, type, 0, 0, interlaced ? 1 : 0], 8);
  const rows = [];
  for (const [x, y, dx, dy] of interlaced ? ADAM7 : [[0, 0, 1, 1]]) {
    const [across, down] = [Math.ceil((width - x) / dx), Math.ceil((height - y) / dy)];
    if (across <= 0) continue;
    for (let row = 0; row < down; row++)
      rows.push(draw(5), ...Array.from({ length: Math.ceil((across * CHANNELS[type] * bits) / 8) }, () => draw(256)));
  }
  const parts = [
    chunk("IHDR", header),
    ...(palette ? [chunk("PLTE", palette)] : []),
    ...(alpha ? [chunk("tRNS", alpha)] : []),
  ];
  return new Uint8Array(
    Buffer.concat([Buffer.from(SIGNATURE), ...parts, chunk("IDAT", deflateSync(Buffer.from(rows))), chunk("IEND", [])]),
  );
}

/** The channels that the facade returns, from those of the file. */
function spread(data, channels, full) {
  const out = [];
  for (let at = 0; at < data.length; at += channels) {
    const [a, b, c] = data.subarray(at, at + channels);
    out.push(...(channels < 3 ? [a, a, a] : [a, b, c]), channels % 2 === 0 ? data[at + channels - 1] : full);
  }
  return out;
}

test("every type of colours, depth of bits and interlace, under every filter, as fast-png decodes it", () => {
  let compared = 0;
  for (const [type, depths] of Object.entries({ 0: [8, 16], 2: [8, 16], 3: [8], 4: [8, 16], 6: [8, 16] })) {
    for (const bits of depths) {
      for (const interlaced of [false, true]) {
        for (const [width, height] of [
          [1, 1],
          [3, 2],
          [9, 17],
          [40, 5],
        ]) {
          const draw = random(1 + compared);
          const palette = type === "3" ? Array.from({ length: 768 }, () => draw(256)) : undefined;
          const file = randomPng({ width, height, bits, type: Number(type), interlaced, draw, palette });
          const theirs = decode(file);
          const expected = palette
            ? spread(convertIndexedToRgb(theirs), 3, 255)
            : spread(theirs.data, theirs.channels, 2 ** bits - 1);
          const { data } = decodeColour(file);
          assert.deepEqual(
            [...data],
            expected,
            `type ${type}, ${bits} bits, ${interlaced ? "interlaced, " : ""}${width}x${height}`,
          );
          compared++;
        }
      }
    }
  }
  assert.equal(compared, 72);
});

test("palettes of 1 to 8 bits, some of them clear, as fast-png decodes them", () => {
  for (const bits of [1, 2, 4, 8]) {
    const draw = random(bits);
    const palette = Array.from({ length: 3 * 2 ** bits }, () => draw(256));
    const alpha = Array.from({ length: 2 ** bits }, () => draw(256));
    const file = randomPng({ width: 13, height: 7, bits, type: 3, draw, palette, alpha });
    const expected = [...convertIndexedToRgb(decode(file))];
    assert.deepEqual([...decodeColour(file).data], expected, `${bits} bits`);
  }
});

test("what a header may not say is refused", async () => {
  const refused = (changes, says) => {
    const file = randomPng({ width: 2, height: 2, bits: 8, type: 0, draw: random(1), ...changes });
    return assert.rejects(readRigFile({ name: "a.png", bytes: file }), says);
  };
  await refused({ bits: 4, type: 2 }, /4 bits per channel/);
  await refused({ bits: 16, type: 3, palette: [0, 0, 0] }, /16 bits per channel/);
  await refused({ bits: 3 }, /3 bits per channel/);
  await refused({ type: 3 }, /palette is missing/);
  await refused({ type: 3, palette: [1, 2] }, /palette is missing or incomplete/);
  await refused({ type: 3, palette: [1, 2, 3], width: 40 }, /palette has no colour/);
});
