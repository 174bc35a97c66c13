/** What every .wasm of the package needs: its code compiled, and the border that every call crosses. */
import { BimodalError, translate } from "./errors.js";
import { nodeModule } from "./node.js";
import type { WasmSource } from "./types.js";

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

/** Runs a call into wasm; its errors come out as `BimodalError`. */
export function across<T>(call: () => T): T {
  try {
    return call();
  } catch (error) {
    throw translate(error);
  }
}

/** Loads a .wasm once, when it is first asked for; a failed one may be repeated. */
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
