// Replays the corpus of scripts/fuzz-readers.mjs: files from the fuzzer, each of which runs code that no fixture and no smaller file runs.
import assert from "node:assert/strict";
import { readFileSync, readdirSync } from "node:fs";
import { describe, test } from "node:test";
import { fileURLToPath } from "node:url";
import { readEveryWay } from "../../scripts/fuzz/read.mjs";

const folder = fileURLToPath(new URL("../../fuzz/corpus/readers", import.meta.url));
/** Least number of files: a missing corpus would pass the other checks. */
const FEWEST = 50;

describe("files that a fuzzer made", () => {
  const names = readdirSync(folder).sort();

  test("each is read or refused by name in every way, in bounded time", async (t) => {
    const failed = [];
    let read = 0;
    for (const name of names) {
      try {
        read += (await readEveryWay(new Uint8Array(readFileSync(`${folder}/${name}`)))) > 0 ? 1 : 0;
      } catch (error) {
        failed.push(`${name}: ${error.stack}`);
      }
    }
    t.diagnostic(`${names.length} files, ${read} of them of use`);
    assert.deepEqual(failed, []);
    assert.ok(names.length >= FEWEST, `${names.length} files`);
    assert.ok(read > 0 && read < names.length, "nothing but errors, or none at all, tests little");
  });
});
