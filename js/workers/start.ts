/** How a worker is started: a module worker of a browser, or one of Node. */
import { compiled } from "../engine.js";
import { nodeModule } from "../node.js";
import { copyOf } from "../plain.js";
import type { Options } from "../types.js";
import { wasmUrl } from "../wasm.js";
import type { Views, WorkerHandle } from "./messages.js";

/**
 * A worker with a copy of the pair, where this place has any. A page may forbid workers, a system may be out of threads or
 * of memory for them.
 */
export function startWorker({ image, depth }: Views, options: Options): WorkerHandle | undefined {
  let worker: WorkerHandle | undefined;
  try {
    worker = spawn();
    const transfer: ArrayBuffer[] = [];
    worker.post(
      { kind: "pair", module: compiled(), image: copyOf(image, transfer), depth: copyOf(depth, transfer), options },
      transfer,
    );
    return worker;
  } catch {
    worker?.end();
    return undefined;
  }
}

function spawn(): WorkerHandle {
  const threads = nodeModule("node:worker_threads");
  return threads ? spawnInNode(threads) : spawnInBrowser();
}

function spawnInBrowser(): WorkerHandle {
  // Written out in one piece: bundlers look for exactly this form to include the file.
  const worker = new Worker(new URL("./thread.js", import.meta.url), { type: "module" });
  return {
    post: (order, transfer) => worker.postMessage(order, transfer),
    onAnswer: (handler) => worker.addEventListener("message", (event) => handler(event.data)),
    onFailure: (handler) =>
      worker.addEventListener("error", (event) => {
        // The estimator does the work itself, so that a console need not show it.
        event.preventDefault();
        handler();
      }),
    end: () => worker.terminate(),
  };
}

function spawnInNode({ Worker }: typeof import("node:worker_threads")): WorkerHandle {
  // Not the URL above once more: bundlers would include the file twice. Nor import.meta.url by itself: webpack writes the path on the
  // machine that bundles in its place.
  const file = new URL("thread.js", wasmUrl());
  // Without the program's own flags: with `node -e TEXT` the worker would be started with the same flag and run TEXT.
  const worker = new Worker(file, { execArgv: [] });
  return {
    post: (order, transfer) => worker.postMessage(order, transfer),
    onAnswer: (handler) => {
      worker.on("message", handler);
      // Adding a listener refs the worker again, and a program would not end before its workers do.
      worker.unref();
    },
    onFailure: (handler) => worker.on("error", handler).on("exit", handler),
    end: () => void worker.terminate(),
  };
}
