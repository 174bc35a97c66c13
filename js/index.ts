/** Entry for browsers and bundlers. */
import { load } from "./engine.js";
import type { Thread } from "./threads.js";
import type { WasmSource } from "./types.js";
import { wasmUrl } from "./wasm.js";

export * from "./main.js";

/** Loads the numerics; without an argument from the .wasm file beside this module that `wasmUrl` names. */
export default function init(wasm?: WasmSource): Promise<void> {
  return load(wasm ?? wasmUrl(), spawn);
}

function spawn(): Thread {
  // Written out in one piece: bundlers look for exactly this to carry the file along.
  const worker = new Worker(new URL("./thread.js", import.meta.url), { type: "module" });
  return {
    post: (order, transfer) => worker.postMessage(order, transfer),
    onAnswer: (hear) => worker.addEventListener("message", (event) => hear(event.data)),
    onFailure: (hear) =>
      worker.addEventListener("error", (event) => {
        // Nobody misses a helper.
        event.preventDefault();
        hear();
      }),
    end: () => worker.terminate(),
  };
}
