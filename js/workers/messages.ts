/** The messages between an estimator and its workers in other threads. */
import type { PlainOptions } from "../options.js";
import type { ColorImage, DepthMap } from "../types/index.js";

/** Both views; every worker gets a copy. */
export interface Views {
  image: ColorImage;
  depth: DepthMap;
}

/** A worker first gets its pair, then tasks of the search, or refinements. */
export type Order =
  | ({ kind: "pair"; module: WebAssembly.Module; options: PlainOptions } & Views)
  | { kind: "task"; task: Float64Array }
  | { kind: "refine"; numbers: Float64Array; planes: Float32Array };

/** The first answer: the pair has been read. */
export const READY = "ready";

/** The numbers that a task of the search returned, or planes of a refined shape; `null` if the worker cannot help, now or later. */
export type WorkerAnswer = Float64Array | Float32Array | typeof READY | null;

/** A worker as its estimator sees it. */
export interface WorkerHandle {
  post(order: Order, transfer: ArrayBuffer[]): void;
  onAnswer(handler: (answer: WorkerAnswer) => void): void;
  onFailure(handler: (reason: unknown) => void): void;
  end(): void;
}
