/** The one wasm module behind all estimators of a page, and the border every call crosses. */
import start, * as glue from "../target/wasm-bindgen/bimodal_stereo.js";
import { BimodalError, translate } from "./errors.js";
import type { WasmSource } from "./types.js";

let loading: Promise<void> | undefined;
let ready = false;

async function loadOnce(wasm: WasmSource): Promise<void> {
  try {
    await start({ module_or_path: wasm });
    ready = true;
  } catch (error) {
    loading = undefined;
    const reason = error instanceof Error ? error.message : String(error);
    throw new BimodalError("init", `init: the .wasm could not be loaded (${reason})`, "wasm", { cause: error });
  }
}

/** Loads the module once; later calls share the first one, and a failed one may be repeated. */
export function load(wasm: WasmSource): Promise<void> {
  loading ??= loadOnce(wasm);
  return loading;
}

/** Whether somebody has already called `init`. */
export const isLoading = (): boolean => loading !== undefined;

/** The generated bindings; only once they are loaded. */
export function bindings(): typeof glue {
  if (!ready) throw new BimodalError("init", "await init() first");
  return glue;
}

/** Runs a call into wasm; its errors come out as `BimodalError`. */
export function across<T>(call: () => T): T {
  try {
    return call();
  } catch (error) {
    throw translate(error);
  }
}
