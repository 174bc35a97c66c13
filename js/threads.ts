/** What an estimator and its helpers in other threads say to each other. */
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
