/** The one wasm module behind all estimators of a page, and the border every call crosses. */
import start, * as glue from "../target/wasm-bindgen/bimodal_stereo.js";
import { BimodalError, translate } from "./errors.js";
import { nodeModule } from "./node.js";
import type { WasmSource } from "./types.js";

let loading: Promise<void> | undefined;
let module: WebAssembly.Module | undefined;

/** The bytes of a file in Node, whose fetch reads none; nothing where the address is no file's. */
function fromDisk(wasm: string | URL | Request | Response): Promise<BufferSource> | undefined {
  const address = typeof wasm === "string" || wasm instanceof URL ? String(wasm) : "";
  return address.startsWith("file:") ? nodeModule("node:fs/promises")?.readFile(new URL(address)) : undefined;
}

export async function compile(wasm: WasmSource): Promise<WebAssembly.Module> {
  if (wasm instanceof WebAssembly.Module) return wasm;
  if (ArrayBuffer.isView(wasm) || wasm instanceof ArrayBuffer) return WebAssembly.compile(wasm);
  const file = fromDisk(wasm);
  if (file) return WebAssembly.compile(await file);
  const response = wasm instanceof Response ? wasm : await fetch(wasm);
  if (!response.ok) throw new Error(`status ${response.status}`);
  // Only what is declared as wasm may be compiled while it arrives.
  const isDeclared = response.headers.get("Content-Type")?.startsWith("application/wasm");
  return isDeclared ? WebAssembly.compileStreaming(response) : WebAssembly.compile(await response.arrayBuffer());
}

async function loadOnce(wasm: WasmSource): Promise<void> {
  try {
    const compiled = await compile(wasm);
    await start({ module_or_path: compiled });
    module = compiled;
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

/** Runs a call into wasm; its errors come out as `BimodalError`. */
export function across<T>(call: () => T): T {
  try {
    return call();
  } catch (error) {
    throw translate(error);
  }
}
