/** Entry for Node, whose fetch does not read files. */
import { readFile } from "node:fs/promises";
import { isLoading, load } from "./engine.js";
import type { WasmSource } from "./types.js";

export * from "./main.js";

const beside = new URL("./bimodal_stereo_bg.wasm", import.meta.url);

/** Loads the numerics; without an argument from the .wasm file beside this module, read from disk. */
export default async function init(wasm: WasmSource = beside): Promise<void> {
  const onDisk = wasm instanceof URL && wasm.protocol === "file:" && !isLoading();
  return load(onDisk ? await readFile(wasm) : wasm);
}
