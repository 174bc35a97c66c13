/** Entry for Node, whose fetch does not read files. */
import { readFile } from "node:fs/promises";
import { Worker } from "node:worker_threads";
import { isLoading, load } from "./engine.js";
import type { Thread } from "./threads.js";
import type { WasmSource } from "./types.js";
import { wasmUrl } from "./wasm.js";

export * from "./main.js";

/** Loads the numerics; without an argument from the .wasm file beside this module that `wasmUrl` names, read from disk. */
export default async function init(wasm: WasmSource = wasmUrl()): Promise<void> {
  const onDisk = wasm instanceof URL && wasm.protocol === "file:" && !isLoading();
  return load(onDisk ? await readFile(wasm) : wasm, spawn);
}

function spawn(): Thread {
  // Without the flags of the program: what it was given as text, as by `node -e`, a helper is not.
  const worker = new Worker(new URL("./thread-node.js", import.meta.url), { execArgv: [] });
  return {
    post: (order, transfer) => worker.postMessage(order, transfer),
    onAnswer: (hear) => {
      worker.on("message", hear);
      // A helper keeps no program from ending; whoever listens to one would.
      worker.unref();
    },
    onFailure: (hear) => worker.on("error", hear).on("exit", hear),
    end: () => void worker.terminate(),
  };
}
