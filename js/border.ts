/** Code that all .wasm files of the package share: it compiles the module, and every call into wasm goes through it. */
import { BimodalError, translate } from "./errors.js";
import { nodeModule } from "./node.js";
import type { WasmSource } from "./types/index.js";

/** The bytes of a file in Node, whose fetch cannot read files; undefined if the address is not that of a file. */
function fromDisk(wasm: string | URL | Request | Response): Promise<BufferSource> | undefined {
  const address = typeof wasm === "string" || wasm instanceof URL ? String(wasm) : "";
  return address.startsWith("file:") ? nodeModule("node:fs/promises")?.readFile(new URL(address)) : undefined;
}

/** Advice for the error that occurs if a bundler has not copied a .wasm. */
const ADVICE =
  "Bundlers that do not follow new URL(.., import.meta.url) do not copy the package's .wasm files. Copy them next to the bundle, " +
  "which must be an ES module, or pass their address to init(url). The package's README has the line for each bundler";

const leftBehind = (what: string, cause?: unknown): Error => new Error(`${what}. ${ADVICE}`, { cause });

function sourceOf(where: () => WasmSource): WasmSource {
  try {
    return where();
  } catch (error) {
    // Scripts that are not ES modules have no import.meta.url.
    throw leftBehind("this bundle does not know its own address", error);
  }
}

/** The code of a .wasm. If the caller gives no address, it is determined here. */
export async function compile(where: () => WasmSource): Promise<WebAssembly.Module> {
  const wasm = sourceOf(where);
  if (wasm instanceof WebAssembly.Module) return wasm;
  if (ArrayBuffer.isView(wasm) || wasm instanceof ArrayBuffer) return WebAssembly.compile(wasm);
  const file = fromDisk(wasm);
  if (file) return WebAssembly.compile(await file);
  const response = wasm instanceof Response ? wasm : await fetch(wasm);
  const type = response.headers.get("Content-Type") ?? "";
  if (!response.ok) throw leftBehind(`status ${response.status} at ${response.url}`);
  // Servers of single-page applications answer unknown addresses with their page.
  if (type.startsWith("text/html")) throw leftBehind(`an HTML page is at ${response.url}`);
  // Only a response declared as wasm can be compiled while it downloads.
  return type.startsWith("application/wasm")
    ? WebAssembly.compileStreaming(response)
    : WebAssembly.compile(await response.arrayBuffer());
}

/** Runs a call into wasm and turns its errors into `BimodalError`. */
export function across<T>(call: () => T): T {
  try {
    return call();
  } catch (error) {
    throw translate(error);
  }
}

/** Loads a .wasm once, on first use; after a failure it can be loaded again. */
export function lazily(field: string, start: () => Promise<unknown>): () => Promise<void> {
  let loading: Promise<unknown> | undefined;
  return async () => {
    loading ??= start();
    try {
      await loading;
    } catch (error) {
      loading = undefined;
      const reason = error instanceof Error ? error.message : String(error);
      throw new BimodalError("init", `${field}: its .wasm could not be loaded (${reason})`, "wasm", { cause: error });
    }
  };
}
