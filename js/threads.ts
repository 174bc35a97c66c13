/** What an estimator and its helpers in other threads say to each other, how they are hired, and their side of it. */
import type { Helper } from "../target/wasm-bindgen/bimodal_stereo.js";
import { bindings, compiled, load, spawn } from "./engine.js";
import { copyOf } from "./plain.js";
import type { ColorImage, DepthMap, Options } from "./types.js";

/** Both views, which every helper gets a copy of. */
export interface Pair {
  image: ColorImage;
  depth: DepthMap;
}

/** A helper first gets its pair, then come tasks of the search, or refinements. */
export type Order =
  | ({ kind: "pair"; module: WebAssembly.Module; options: Options } & Pair)
  | { kind: "task"; task: Float64Array }
  | { kind: "refine"; numbers: Float64Array; planes: Float32Array };

/** What the first answer says: the pair has been read. */
export const READY = "ready";

/** Numbers of a task's finding, planes of a refined shape; `null` where nothing can be found, now or later. */
export type Answer = Float64Array | Float32Array | typeof READY | null;

/** The end of a thread that the estimator holds. */
export interface Thread {
  post(order: Order, transfer: ArrayBuffer[]): void;
  onAnswer(hear: (answer: Answer) => void): void;
  onFailure(hear: () => void): void;
  end(): void;
}

/**
 * A thread with a copy of the pair, where this place has any. A page may forbid workers, a system may be out of threads or
 * of memory for them.
 */
export function hire({ image, depth }: Pair, options: Options): Thread | undefined {
  let thread: Thread | undefined;
  try {
    thread = spawn();
    const transfer: ArrayBuffer[] = [];
    thread?.post({ kind: "pair", module: compiled(), image: copyOf(image, transfer), depth: copyOf(depth, transfer), options }, transfer);
    return thread;
  } catch {
    thread?.end();
    return undefined;
  }
}

/** Handles one order after the other, in the helper's thread. */
export function serve(answer: (answer: Answer, transfer: ArrayBuffer[]) => void): (order: Order) => void {
  let helper: Helper | undefined;

  async function handle(order: Order): Promise<void> {
    switch (order.kind) {
      case "pair":
        await load(order.module);
        helper = new (bindings().Helper)(order.image, order.depth, order.options);
        return answer(READY, []);
      case "task":
        return answer(helper?.perform(order.task) ?? null, []);
      case "refine": {
        const refined = helper?.refine(order.numbers, order.planes) ?? null;
        return answer(refined, refined ? [refined.buffer as ArrayBuffer] : []);
      }
    }
  }

  let last: Promise<void> = Promise.resolve();
  return (order) => {
    last = last.then(() => handle(order)).catch(() => answer(null, []));
  };
}
