/** The one wasm module behind all estimators of a page. */
import start, * as glue from "../target/wasm-bindgen/bimodal_stereo.js";
import { compile } from "./border.js";
import { BimodalError } from "./errors.js";
import type { WasmSource } from "./types.js";

let loading: Promise<void> | undefined;
let module: WebAssembly.Module | undefined;

async function loadOnce(where: () => WasmSource): Promise<void> {
  try {
    const compiled = await compile(where);
    await start({ module_or_path: compiled });
    module = compiled;
  } catch (error) {
    loading = undefined;
    const reason = error instanceof Error ? error.message : String(error);
    throw new BimodalError("init", `init: the .wasm could not be loaded (${reason})`, "wasm", { cause: error });
  }
}

/** Loads the module once; later calls share the first one, and a failed one may be repeated. */
export function load(where: () => WasmSource): Promise<void> {
  loading ??= loadOnce(where);
  return loading;
}

/** The compiled module, which other threads can start as well. */
export function compiled(): WebAssembly.Module {
  if (!module) throw new BimodalError("init", "await init() first");
  return module;
}

/** The generated bindings; only once they are loaded. */
export function bindings(): typeof glue {
  compiled();
  return glue;
}
