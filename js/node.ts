/** Entry for Node, whose fetch does not read files. */
import { readFile } from "node:fs/promises";
import { isLoading, load } from "./engine.js";
import type { WasmSource } from "./types.js";
import { wasmUrl } from "./wasm.js";

export * from "./main.js";

/** Loads the numerics; without an argument from the .wasm file beside this module that `wasmUrl` names, read from disk. */
export default async function init(wasm: WasmSource = wasmUrl()): Promise<void> {
  const onDisk = wasm instanceof URL && wasm.protocol === "file:" && !isLoading();
  return load(onDisk ? await readFile(wasm) : wasm);
}
