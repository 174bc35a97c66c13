// Randomly changed files of a rig: each is read or gives an error that names it, in bounded time and memory.
import assert from "node:assert/strict";
import { readdirSync } from "node:fs";
import { test } from "node:test";
import { fileURLToPath } from "node:url";
import { BimodalError, readRigFile } from "../../pkg/rig.js";
import { assertSmall, bytes, inTime } from "./malformed.mjs";
import { CALIBRATION_SAMPLES } from "./product-calibrations.mjs";
import { PICTURE_SAMPLES } from "./product-pictures.mjs";
import { PRINT_SAMPLES } from "./product-prints.mjs";
import { fixture } from "./rig-support.mjs";

/** Mulberry32, for the same cases in each run. */
function generator(seed) {
  let state = seed >>> 0;
  return () => {
    state = (state + 0x6d2b79f5) >>> 0;
    let mixed = Math.imul(state ^ (state >>> 15), state | 1);
    mixed ^= mixed + Math.imul(mixed ^ (mixed >>> 7), mixed | 61);
    return ((mixed ^ (mixed >>> 14)) >>> 0) / 2 ** 32;
  };
}

const CASES = process.env.LONG_TESTS ? 120 : 12;
/** Cases for each file of a product; these files are short. */
const CASES_OF_PRODUCTS = process.env.LONG_TESTS ? 40 : 10;
const KINDS = ["colour", "depth", "mask", "cameras", "poses", undefined, undefined, undefined];
const BYTES = [0, 255, 127, 128, 45, 48, 57, 10];

/** Truncates, changes bits and bytes (more often in the header than behind it), or inserts bytes. */
function mutated(file, random) {
  const below = (count) => Math.floor(random() * count);
  if (random() < 0.3) return file.slice(0, below(file.length));
  const copy = random() < 0.1 ? bytes(file.subarray(0, 40), new Uint8Array(below(9)), file.subarray(40)) : file.slice();
  for (let change = 1 + below(5); change > 0; change--) {
    const at = below(random() < 0.5 ? Math.min(copy.length, 200) : copy.length);
    copy[at] = random() < 0.5 ? copy[at] ^ (1 << below(8)) : BYTES[below(BYTES.length)];
  }
  return copy;
}

const folder = fileURLToPath(new URL("../fixtures/rig", import.meta.url));
// Subfolders hold the output of writers.
const fixtures = readdirSync(folder, { withFileTypes: true })
  .filter((entry) => entry.isFile())
  .map(({ name }) => ({ name, content: fixture(name), cases: CASES }))
  .sort((a, b) => (a.name < b.name ? -1 : 1));
const products = await Promise.all(
  Object.values({ ...CALIBRATION_SAMPLES, ...PICTURE_SAMPLES, ...PRINT_SAMPLES }).map(async ({ name, bytes: own }) => ({
    ...{ name, content: await own, cases: CASES_OF_PRODUCTS },
  })),
);

const total = (files) => files.reduce((sum, { cases }) => sum + cases, 0);
// Smallest shares of the cases that are read and of those that are refused.
for (const [what, files, [leastRead, leastRefused]] of [
  ["fixtures", fixtures, [0.044, 0.443]],
  ["files of products", products, [0.076, 0.255]],
])
  test(`${what}, changed ${total(files)} times, end in a reading or in a BimodalError that names the file`, async () => {
    const random = generator(15);
    let [read, refused] = [0, 0];
    for (const { name, content: file, cases } of files) {
      for (let index = 0; index < cases; index++) {
        const as = KINDS[Math.floor(random() * KINDS.length)];
        const content = mutated(file, random);
        await inTime(`${name}, case ${index}`, async () => {
          try {
            const reading = await readRigFile({ name, bytes: content }, as && { as });
            assert.ok(reading.says.length > 0 && Array.isArray(reading.warnings));
            read++;
          } catch (error) {
            assert.ok(
              error instanceof BimodalError && error.code === "file" && error.message.includes(name),
              `${name}, case ${index}: ${error.stack}`,
            );
            refused++;
          }
        });
      }
    }
    const [isRead, isRefused] = [read > leastRead * total(files), refused > leastRefused * total(files)];
    assert.ok(isRead && isRefused, `${read} read, ${refused} refused`);
  });

test("no file took a gigabyte", assertSmall);
