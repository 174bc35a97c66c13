/** What an estimator and the scouts in other threads say to each other, and the scout's side of it. */
import type { Scout } from "../target/wasm-bindgen/bimodal_stereo.js";
import { bindings, load } from "./engine.js";
import type { ColorImage, DepthMap, Options } from "./types.js";

/** A scout serves one search: first it hears of which, then come tasks. */
export type Order =
  | { kind: "search"; module: WebAssembly.Module; image: ColorImage; depth: DepthMap; options: Options }
  | { kind: "task"; task: Float64Array };

/** `null` where nothing can be found, now or later: the estimator then goes on without this scout. */
export type Answer = Float64Array | null;

/** The end of a thread that the estimator holds. */
export interface Thread {
  post(order: Order, transfer: ArrayBuffer[]): void;
  onAnswer(hear: (answer: Answer) => void): void;
  onFailure(hear: () => void): void;
  end(): void;
}

/** Handles one order after the other, in the thread of the scout. */
export function serve(answer: (answer: Answer) => void): (order: Order) => void {
  let scout: Scout | undefined;

  async function handle(order: Order): Promise<void> {
    if (order.kind === "task") {
      answer(scout?.perform(order.task) ?? null);
      return;
    }
    await load(order.module);
    scout = new (bindings().Scout)(order.image, order.depth, order.options);
  }

  let last: Promise<void> = Promise.resolve();
  return (order) => {
    last = last.then(() => handle(order)).catch(() => answer(null));
  };
}
