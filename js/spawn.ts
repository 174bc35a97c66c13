/** How a helper is hired: in a module worker of a browser, or a worker of Node. */
import { compiled } from "./engine.js";
import { nodeModule } from "./node.js";
import { copyOf } from "./plain.js";
import type { Pair, Thread } from "./threads.js";
import type { Options } from "./types.js";

/**
 * A thread with a copy of the pair, where this place has any. A page may forbid workers, a system may be out of threads or
 * of memory for them.
 */
export function hire({ image, depth }: Pair, options: Options): Thread | undefined {
  let thread: Thread | undefined;
  try {
    thread = spawn();
    const transfer: ArrayBuffer[] = [];
    thread.post({ kind: "pair", module: compiled(), image: copyOf(image, transfer), depth: copyOf(depth, transfer), options }, transfer);
    return thread;
  } catch {
    thread?.end();
    return undefined;
  }
}

function spawn(): Thread {
  const threads = nodeModule("node:worker_threads");
  return threads ? spawnInNode(threads) : spawnInBrowser();
}

function spawnInBrowser(): Thread {
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

function spawnInNode({ Worker }: typeof import("node:worker_threads")): Thread {
  // In another piece than above, lest bundlers carry the file along twice.
  const file = import.meta.url.replace(/[^/]*$/, "thread.js");
  // Without the flags of the program: what it was given as text, as by `node -e`, a helper is not.
  const worker = new Worker(new URL(file), { execArgv: [] });
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
