/** The code of a worker's thread: it handles one message after the other. */
import type { Worker as Native } from "../../target/wasm-bindgen/bimodal_stereo.js";
import { bindings, load } from "../engine.js";
import { nodeModule } from "../node.js";
import { READY, type WorkerAnswer, type Order } from "./messages.js";

function serve(answer: (answer: WorkerAnswer, transfer: ArrayBuffer[]) => void): (order: Order) => void {
  let native: Native | undefined;

  async function handle(order: Order): Promise<void> {
    switch (order.kind) {
      case "pair":
        await load(() => order.module);
        native = new (bindings().Worker)(order.image, order.depth, order.options);
        return answer(READY, []);
      case "task":
        return answer(native?.perform(order.task) ?? null, []);
      case "refine": {
        const refined = native?.refine(order.numbers, order.planes) ?? null;
        return answer(refined, refined ? [refined.buffer as ArrayBuffer] : []);
      }
    }
  }

  let last: Promise<void> = Promise.resolve();
  return (order) => {
    last = last.then(() => handle(order)).catch(() => answer(null, []));
  };
}

const port = nodeModule("node:worker_threads")?.parentPort;
if (port) {
  port.on(
    "message",
    serve((answer, transfer) => port.postMessage(answer, transfer)),
  );
} else {
  const handle = serve((answer, transfer) => self.postMessage(answer, { transfer }));
  self.onmessage = (event: MessageEvent<Order>) => handle(event.data);
}
