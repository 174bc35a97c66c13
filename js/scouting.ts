/** What an estimator and the scouts in other threads say to each other, and the scout's side of it. */
import type { Scout } from "../target/wasm-bindgen/bimodal_stereo.js";
import { bindings, load } from "./engine.js";
import type { ColorImage, DepthMap, Options } from "./types.js";

/** A search is one run of the estimator; what belongs to an earlier one is stale. */
export type Order =
  | { kind: "meet"; module: WebAssembly.Module; image: ColorImage; depth: DepthMap }
  | { kind: "search"; run: number; options: Options }
  | { kind: "task"; run: number; task: Float64Array }
  | { kind: "rest" };

/** `null` where nothing can be found, now or later: the estimator then goes on without this scout. */
export interface Answer {
  run: number;
  finding: Float64Array | null;
}

/** The end of a thread that the estimator holds. */
export interface Thread {
  post(order: Order, transfer: ArrayBuffer[]): void;
  onAnswer(hear: (answer: Answer) => void): void;
  onFailure(hear: () => void): void;
  end(): void;
}

/** Handles one order after the other, in the thread of the scout. */
export function serve(answer: (answer: Answer) => void): (order: Order) => void {
  let pair: { image: ColorImage; depth: DepthMap } | undefined;
  let scout: Scout | undefined;

  async function handle(order: Order): Promise<void> {
    switch (order.kind) {
      case "meet":
        pair = order;
        return load(order.module);
      case "search":
        scout?.free();
        scout = undefined;
        if (pair) scout = new (bindings().Scout)(pair.image, pair.depth, order.options);
        return;
      case "task":
        answer({ run: order.run, finding: scout?.perform(order.task) ?? null });
        return;
      case "rest":
        scout?.free();
        scout = undefined;
    }
  }

  let last: Promise<void> = Promise.resolve();
  return (order) => {
    last = last.then(() => handle(order)).catch(() => answer({ run: "run" in order ? order.run : 0, finding: null }));
  };
}
