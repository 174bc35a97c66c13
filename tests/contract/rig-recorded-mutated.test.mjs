// Recordings with random bytes changed, removed or copied: each is read or gives a BimodalError that names the file, in bounded time.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";
import { fileURLToPath } from "node:url";
import { BimodalError, openRecording } from "../../pkg/rig-recordings.js";
import { generator } from "../../scripts/fuzz/random.mjs";
import { frames, recorded } from "./recorded.mjs";
import { lz4Frame, matroska, mcap } from "./recordings.mjs";

function mutated(bytes, { below }) {
  const copy = new Uint8Array(bytes);
  for (let i = 1 + below(6); i > 0; i--) copy[below(copy.length)] = below(4) === 0 ? 255 : below(256);
  const kind = below(4);
  if (kind === 0) return copy.subarray(0, below(copy.length));
  if (kind === 1) copy.copyWithin(below(copy.length), below(copy.length), below(copy.length));
  return copy;
}

const fixture = (name) => readFileSync(fileURLToPath(new URL(`../fixtures/recordings/${name}`, import.meta.url)));
const compressChunk = (data) => ({ compression: "lz4", compressedData: lz4Frame(data) });
const SOURCES = {
  "a.mcap": () => mcap(recorded({ compress: true }, 2), { compressChunk }),
  "b.mcap": () => mcap(recorded({}, 2), { chunks: false }),
  "c.mcap": () => mcap(recorded({ compress: true }, 2), { generation: "ros1" }),
  "d.bag": async () => fixture("depth-none.bag"),
  "e.bag": async () => fixture("depth-bz2.bag"),
  "f.mkv": async () => matroska(frames(2), "{}"),
};
const COUNT = process.env.LONG_TESTS ? 400 : 40;
/** Milliseconds, far more than any of these takes on a busy machine. */
const SLOW = 20_000;

for (const [name, make] of Object.entries(SOURCES))
  test(`${name} with random changes is read or refused`, async () => {
    const bytes = await make();
    const random = generator(bytes.length);
    for (let i = 0; i < COUNT; i++) {
      const content = mutated(bytes, random);
      const start = performance.now();
      try {
        await (await openRecording({ name, content })).read();
      } catch (error) {
        assert.ok(error instanceof BimodalError, `${name} ${i}: ${error.stack}`);
        assert.ok(error.message.startsWith(`${name}: `), error.message);
      }
      assert.ok(performance.now() - start < SLOW, `${name} ${i} took too long`);
    }
  });
