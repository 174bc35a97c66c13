/** Entry for browsers and bundlers. */
import { load } from "./engine.js";
import type { WasmSource } from "./types.js";
import { wasmUrl } from "./wasm.js";

export * from "./main.js";

/** Loads the numerics; without an argument from the .wasm file beside this module that `wasmUrl` names. */
export default function init(wasm?: WasmSource): Promise<void> {
  return load(wasm ?? wasmUrl());
}
