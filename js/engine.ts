/** The one wasm module behind all estimators of a page. */
import start, * as glue from "../target/wasm-bindgen/bimodal_stereo.js";
import { compile } from "./border.js";
import { BimodalError, isPanic, translate } from "./errors.js";
import type { WasmSource } from "./types/index.js";

let loading: Promise<void> | undefined;
let module: WebAssembly.Module | undefined;
let memory: WebAssembly.Memory | undefined;

/** A function that only our module exports. Another module has to be refused before the start, because the bindings never forget a failed one. */
const OWN = "sample";

async function loadOnce(where: () => WasmSource): Promise<void> {
  try {
    const compiled = await compile(where);
    if (!WebAssembly.Module.exports(compiled).some(({ name }) => name === OWN))
      throw new Error("it is not the .wasm of this package");
    ({ memory } = await start({ module_or_path: compiled }));
    module = compiled;
  } catch (error) {
    loading = undefined;
    const reason = error instanceof Error ? error.message : String(error);
    throw new BimodalError("init", `init: the .wasm could not be loaded (${reason})`, "wasm", { cause: error });
  }
}

/** Loads the module once; later calls share it, and a failed load can be repeated. */
export function load(where: () => WasmSource): Promise<void> {
  loading ??= loadOnce(where);
  return loading;
}

/** Loads the compiled module synchronously, for callers that cannot wait. */
export function loadNow(compiled: WebAssembly.Module): void {
  ({ memory } = glue.initSync({ module: compiled }));
  module = compiled;
}

/** The compiled module, which other threads can start as well. */
export function compiled(): WebAssembly.Module {
  if (!module) throw new BimodalError("init", "await init() first");
  return module;
}

/** Memory that a raster of a large view needs, in pages of 64 kB: 256 MB. */
const ROOM = 4096;

/** Whether the module cannot get more memory. */
function isFull(): boolean {
  try {
    memory?.grow(ROOM);
    return false;
  } catch {
    return true;
  }
}

/** Turns an error of the numerics into a `BimodalError`. If a call crashed and memory was full, memory was the cause. */
export function explained(error: unknown): unknown {
  if (!isPanic(error) || !isFull()) return translate(error);
  const message = "image: there is no memory left for this pair; free() estimators that are no longer needed";
  return new BimodalError("memory", message, "image", { cause: error });
}

/** The generated bindings. It is an error to call this before the module is loaded. */
export function bindings(): typeof glue {
  compiled();
  return glue;
}
