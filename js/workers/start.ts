/** How a worker is started: a module worker of a browser, or one of Node. */
import { compiled } from "../engine.js";
import { nodeModule } from "../node.js";
import { copyOf } from "../plain.js";
import type { PlainOptions } from "../options.js";
import { wasmUrl } from "../wasm.js";
import type { Views, WorkerHandle } from "./messages.js";

/**
 * A worker with a copy of the pair, if workers are available. A page may forbid workers, and a system may be out of threads or of memory
 * for them; `unavailable` is then called with the reason.
 */
export function startWorker(
  { image, depth }: Views,
  options: PlainOptions,
  unavailable: (reason: unknown) => void,
): WorkerHandle | undefined {
  let worker: WorkerHandle | undefined;
  try {
    worker = spawn();
    // A worker that was ended before it was ready has not failed.
    const { end } = worker;
    let isSettled = false;
    worker.end = () => {
      isSettled = true;
      end();
    };
    worker.onAnswer(() => (isSettled = true));
    worker.onFailure((reason) => {
      if (!isSettled) unavailable(reason);
      isSettled = true;
    });
    const transfer: ArrayBuffer[] = [];
    worker.post(
      { kind: "pair", module: compiled(), image: copyOf(image, transfer), depth: copyOf(depth, transfer), options },
      transfer,
    );
    return worker;
  } catch (error) {
    worker?.end();
    unavailable(error);
    return undefined;
  }
}

function spawn(): WorkerHandle {
  const threads = nodeModule("node:worker_threads");
  return threads ? spawnInNode(threads) : spawnInBrowser();
}

/**
 * A page may import modules from other origins, but start workers only from its own. A local worker that imports the module satisfies both
 * rules; it needs thread.js beside the .wasm under this name, which a bundler may change.
 */
function foreignWorker(thread: URL): Worker {
  const text = `import ${JSON.stringify(thread.href)};`;
  const address = URL.createObjectURL(new Blob([text], { type: "text/javascript" }));
  const worker = new Worker(address, { type: "module" });
  const forget = () => URL.revokeObjectURL(address);
  worker.addEventListener("message", forget, { once: true });
  worker.addEventListener("error", forget, { once: true });
  return worker;
}

function ownWorker(): Worker {
  // Written as one expression, because bundlers look for exactly this form to include the file.
  return new Worker(new URL("./thread.js", import.meta.url), { type: "module" });
}

function spawnInBrowser(): WorkerHandle {
  const thread = new URL("thread.js", wasmUrl());
  const worker = thread.origin === self.location.origin ? ownWorker() : foreignWorker(thread);
  return {
    post: (order, transfer) => worker.postMessage(order, transfer),
    onAnswer: (handler) => worker.addEventListener("message", (event) => handler(event.data)),
    onFailure: (handler) =>
      worker.addEventListener("error", (event) => {
        // The estimator does the work itself and warns, so the console need not show the error again.
        event.preventDefault();
        handler(event.message || `${thread.href} could not be loaded`);
      }),
    end: () => worker.terminate(),
  };
}

function spawnInNode({ Worker }: typeof import("node:worker_threads")): WorkerHandle {
  // The URL above is not repeated, because bundlers would include the file twice. import.meta.url by itself is not used, because webpack
  // replaces it with the path on the machine that bundles.
  const file = new URL("thread.js", wasmUrl());
  // The worker does not get the program's own flags, because with `node -e TEXT` it would also run TEXT.
  const worker = new Worker(file, { execArgv: [] });
  return {
    post: (order, transfer) => worker.postMessage(order, transfer),
    onAnswer: (handler) => {
      worker.on("message", handler);
      // A new listener keeps the program alive as long as its workers, so the worker is released again.
      worker.unref();
    },
    onFailure: (handler) => worker.on("error", handler).on("exit", () => handler("it ended")),
    end: () => void worker.terminate(),
  };
}
