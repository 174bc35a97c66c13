/** The estimator's arrays, each copied when it is first asked for after a step. */

import type { Estimator } from "../../pkg/index.js";

type Name =
  | "imageNormals"
  | "imageDepth"
  | "albedo"
  | "shading"
  | "residual"
  | "refinedDepth"
  | "depthNormals"
  | "correspondence";

export class Numbers {
  readonly #estimator: Estimator;
  readonly #kept = new Map<string, Float32Array | Int32Array>();

  constructor(estimator: Estimator) {
    this.#estimator = estimator;
  }

  of<N extends Name>(name: N): ReturnType<Estimator[N]> {
    return this.#keep(name, () => this.#estimator[name]()) as ReturnType<Estimator[N]>;
  }

  points(view: "image" | "depth"): Float32Array {
    return this.#keep(`points ${view}`, () => this.#estimator.points(view));
  }

  /** Discards the numbers, because they change with each step. */
  forget(): void {
    this.#kept.clear();
  }

  #keep<T extends Float32Array | Int32Array>(name: string, copy: () => T): T {
    const kept = this.#kept.get(name) ?? copy();
    this.#kept.set(name, kept);
    return kept as T;
  }
}
