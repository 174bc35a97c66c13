// init() with a .wasm that is another program is refused, and leaves nothing behind.
import assert from "node:assert/strict";
import { readFile } from "node:fs/promises";
import { test } from "node:test";
import { init, sample } from "./support.mjs";

test("another program is refused by init(), and the right one taken after it", async () => {
  const empty = new WebAssembly.Module(Uint8Array.of(0, 97, 115, 109, 1, 0, 0, 0));
  const check = await readFile(new URL("../../pkg/bimodal_stereo_check_bg.wasm", import.meta.url));
  for (const wasm of [empty, check])
    await assert.rejects(init(wasm), { name: "BimodalError", code: "init", message: /not the \.wasm of this package/ });
  await init();
  assert.equal(sample({ surface: "bust", light: "window", size: 16 }).image.width, 16);
});
