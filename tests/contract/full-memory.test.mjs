// Exhausted memory is a named error. Four gigabytes are too much for a test, so the module gets a lower limit.
import assert from "node:assert/strict";
import { readFile } from "node:fs/promises";
import { test } from "node:test";
import { Estimator, estimator, init, refused, sample } from "./support.mjs";

const PAGE = 65_536;
/** Limit of the memory, bytes: enough for a small pair and for a few pairs of 400x400. */
const GRANTED = 120e6;
const MEMORY_SECTION = 5;

/** An unsigned LEB128 number, and the position after it. */
function leb128(bytes, at) {
  let [value, shift] = [0, 0];
  for (; ; shift += 7) {
    const byte = bytes[at++];
    value |= (byte & 127) << shift;
    if (byte < 128) return [value >>> 0, at];
  }
}
const asLeb128 = (value) => (value < 128 ? [value] : [(value & 127) | 128, ...asLeb128(value >>> 7)]);

/** The module with an upper limit of its memory, in pages. */
function limited(bytes, pages) {
  for (let at = 8; at < bytes.length; ) {
    const [size, from] = leb128(bytes, at + 1);
    if (bytes[at] === MEMORY_SECTION) {
      const [initial] = leb128(bytes, from + 2);
      const section = [1, 1, ...asLeb128(initial), ...asLeb128(pages)];
      return Buffer.concat([
        bytes.subarray(0, at),
        Buffer.from([MEMORY_SECTION, ...asLeb128(section.length), ...section]),
        bytes.subarray(from + size),
      ]);
    }
    at = from + size;
  }
  throw new Error("no memory");
}

test("full memory is named; what is freed can be had again", async () => {
  await init(
    limited(await readFile(new URL("../../pkg/bimodal_stereo_bg.wasm", import.meta.url)), Math.floor(GRANTED / PAGE)),
  );
  const { image, depth } = sample({ surface: "bust", light: "window", size: 400 });
  const made = [];
  const fill = () => {
    while (made.length < 50) made.push(new Estimator(image, depth, { start: "identity" }));
  };
  refused(fill, "memory", "image");
  assert.ok(made.length >= 1);
  assert.throws(fill, /free\(\) estimators/);
  made.forEach((one) => one.free());
  const other = estimator();
  assert.equal(other.step().iteration, 1);
});
