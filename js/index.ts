/** Entry for browsers and bundlers. */
import { load } from "./engine.js";
import type { WasmSource } from "./types.js";

export * from "./main.js";

/** Loads the numerics; without an argument from the .wasm file beside this module. */
export default function init(wasm?: WasmSource): Promise<void> {
  // Written out in one piece: bundlers look for exactly this to carry the file along.
  return load(wasm ?? new URL("./bimodal_stereo_bg.wasm", import.meta.url));
}
